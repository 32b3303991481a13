// The normal equations of one frame of a person whom points, joints and markers are to be matched with.
#pragma once

#include <vector>

#include "retarget/motion_space/person_model.hpp"

namespace understudy {

constexpr int kPoseUnknowns = 3 + 3 * kJointCount;  ///< the root's way, then each joint's turn

/// A person in a pose, and how all of it moves with what is unknown: the root's way (world), each joint's
/// turn (about axes of its parent, R <- exp(u) R) and the shape.
class PosedPerson {
 public:
  PosedPerson(const PersonModel& model, const Eigen::VectorXf& shape, const Points& rest, const Pose& pose);

  const PosedSkeleton& skeleton() const { return skeleton_; }
  const Points& vertices() const { return vertices_; }
  const Points& normals() const { return normals_; }
  const Joints& rest() const { return rest_; }

 private:
  friend class FrameEquations;
  const PersonModel& model_;
  Joints rest_;
  PosedSkeleton skeleton_;
  Points vertices_, normals_;
  std::vector<Joints> joint_slopes_;  // of each shape parameter, world
  const Points& rest_vertices_;
};

/// Sums of J^T W J and J^T W r over terms with residuals r = wanted - is. World turns until parent_axes().
class FrameEquations {
 public:
  FrameEquations(const PosedPerson& person, bool with_shape);

  /// A vertex is off by the residual; `weight` [3, 3].
  void add_vertex(int vertex, const Mat3& weight, const Vec3& weighted_residual);
  /// A joint's place.
  void add_joint(int joint, float weight, const Vec3& residual);
  /// A place that a bone carries, beside its joint in T-pose axes.
  void add_carried(int bone, const Vec3& offset, float weight, const Vec3& residual);
  /// A joint's world rotation: `turn` takes it where it should be.
  void add_turn(int joint, float weight, const Vec3& turn);
  /// From turns in the world to turns about the parents' axes. Once, after all terms.
  void parent_axes();

  Eigen::MatrixXd H;  ///< [69 + S, 69 + S], lower half
  Eigen::VectorXd g;

 private:
  using Slopes = Eigen::Matrix<float, 3, Eigen::Dynamic, 0, 3, kPoseUnknowns + 24>;
  void add(const Slopes& slopes, const Mat3& weight, const Vec3& weighted_residual);
  void begin_columns();
  void add_column(int joint);

  const PosedPerson& person_;
  int shapes_;
  std::vector<int> columns_;  // of the unknowns that a term has to do with, three at a time
  Slopes slopes_;
};

}  // namespace understudy
