// Joints of a posed surface that was moved without a skeleton, so that it can be judged as the others are.
#pragma once

#include <array>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Each joint moves rigidly with the ring of vertices that belong to its bone and to its parent's alike.
class SurfaceJoints {
 public:
  /// rest [V, 3] and joints in T-pose; weights [V, 22]. Joints without a ring move with their parent's.
  SurfaceJoints(const Points& rest, const RowMatrix& weights, const Joints& joints);
  /// Of the surface posed, [V, 3]. Throws Error when it has another number of vertices.
  Joints of(const Points& posed) const;

 private:
  struct Ring {
    std::vector<int> vertices;
    Eigen::VectorXf weights;  // sum to 1
    Points rest;              // around their mean
    Vec3 joint;               // from that mean, in T-pose
  };
  std::array<Ring, kJointCount> rings_;
  Eigen::Index count_;
};

}  // namespace understudy
