// What is true of a body that moves, of whatever kind: its surface, joints, bones and weights over time.
#pragma once

#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

/// T frames of V vertices and J joints, world, metres.
struct RigTruth {
  std::vector<Points> vertices;    ///< [T] of [V, 3]
  Faces faces{0, 3};               ///< [F, 3]
  Points rest{0, 3};               ///< [V, 3]
  std::vector<Points> joints;      ///< [T] of [J, 3]
  std::vector<int> parents;        ///< [J], each before its children; joint 0 is the root, -1
  RowMatrix weights;               ///< [V, J]
  std::vector<BoneMotions> bones;  ///< [T] of [J], from rest
  std::vector<Vec3> axes;          ///< [J] of hinges, unit length at rest; zero: no hinge
  int count() const { return static_cast<int>(parents.size()); }
  int frames() const { return static_cast<int>(vertices.size()); }
};
/// Throws Error naming what disagrees in size, or what is not finite.
void check_rig_truth(const RigTruth& truth);

/// The truth of a rig and what it performs, its surface skinned.
RigTruth truth_of(const RiggedMotion& performed);

/// The mean over frames of the diagonal of the box about the vertices, metres: what figures are a share of.
double body_size(const std::vector<Points>& vertices);

/// What never moves cannot be found: a bone that turns by less than 5 degrees against its parent (the largest
/// angle between any two frames) and whose joint stays within 1 % of body_size() of one place on the parent
/// is one part with it, and its joint is left out. Of more than 300 frames 300 are compared.
RigTruth merged_truth(const RigTruth& truth);

}  // namespace understudy
