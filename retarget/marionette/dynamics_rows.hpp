// Motions as rows of numbers for a network of their dynamics, and poses from such rows.
#pragma once

#include <string>

#include "retarget/marionette/motion_form.hpp"

namespace understudy {

/// A rig's bones in words: "name:parent;name:parent;". Rigs of one kind have the same.
std::string bones_of(const Rig& rig);

/// MotionForm's rows with a rotation of every joint, whatever its kind, and without what stands.
class DynamicsRows {
 public:
  explicit DynamicsRows(const Rig& rig);
  DynamicsRows(const DynamicsRows&) = delete;
  DynamicsRows& operator=(const DynamicsRows&) = delete;

  int width() const { return 4 + 6 * rig_.count(); }
  RowMatrix rows(const RigMotion& motion) const;  ///< [T, width()]
  /// Of a pose that comes dt seconds after the one before.
  Eigen::RowVectorXf row(const RigPose& before, const RigPose& pose, double dt) const;
  Eigen::RowVectorXf first_row(const RigPose& pose) const;  ///< speeds 0
  /// The pose that this row says, dt seconds after that one; joints do what their kinds allow.
  RigPose pose(const RigPose& before, const Eigen::RowVectorXf& row, double dt) const;
  /// The same of a row with places of joints about the root, [4 + 3 J].
  RigPose pose_at(const RigPose& before, const Eigen::RowVectorXf& row, double dt) const;
  Eigen::RowVectorXf places_row(const RigPose& pose, const Eigen::RowVectorXf& row) const;
  Points rest() const;  ///< [J, 3] about the root, sizes
  float size() const { return form_.size(); }
  const Rig& rig() const { return rig_; }

 private:
  Rig rig_, free_;  // as it is; with balls for joints
  MotionForm form_;
};

}  // namespace understudy
