// A motion as rows of numbers in which patches can be compared and blended.
#pragma once

#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

/// Rows of a motion, [T, width()]: how the root goes and turns since the frame before, in its own heading,
/// its height and tilt, each joint's turn (6D) or slide, and which bones stand. Lengths are sizes of the
/// body, times seconds.
class MotionForm {
 public:
  /// Columns of how the root goes over the floor: two speeds, then how fast it turns; its height.
  static constexpr int kSpeed = 0, kTurn = 2, kHeight = 3, kTilt = 4;

  explicit MotionForm(const Rig& rig);
  int width() const { return stands_ + static_cast<int>(rig_.joints.size()); }
  float size() const { return size_; }  ///< metres
  /// How the root goes, sizes a second, in its heading of the frame before.
  static Vec3 way(const Eigen::RowVectorXf& row) { return {row[kSpeed], 0, row[kSpeed + 1]}; }
  /// How much a column counts when rows are compared; 0 of what is only carried along.
  const Eigen::RowVectorXf& weights() const { return weights_; }

  /// touches: [T][J], empty: nothing stands. The first row goes as the second does.
  RowMatrix rows(const RigMotion& motion, const std::vector<std::vector<char>>& touches) const;
  /// A pose's own columns, how it goes left at zero.
  Eigen::RowVectorXf row_of(const RigPose& pose) const;
  /// The columns of row_of() but those of how it goes and what stands.
  void put_pose(const Eigen::RowVectorXf& own, Eigen::Ref<Eigen::RowVectorXf> row) const;
  /// Poses from rows, the first one's root above `start` facing as it did.
  RigMotion motion(const RowMatrix& rows, const RigPose& start, double fps) const;
  std::vector<std::vector<char>> touches(const RowMatrix& rows) const;

 private:
  RigPose pose(const Eigen::RowVectorXf& row) const;

  const Rig& rig_;
  float size_;
  std::vector<int> column_;  // of each joint, -1: none
  int stands_ = 0;           // the first column of what stands
  Eigen::RowVectorXf weights_;
};

}  // namespace understudy
