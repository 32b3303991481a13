// A motion of the 22 joints as a Biovision file.
#pragma once

#include <array>
#include <string>

#include "retarget/base/part_file.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Centimetres, y up, the T-pose where all angles are zero; the pelvis has position and rotation, the others
/// rotation, Z X Y in degrees, unwound so that curves have no jumps. Frames go to the file as they come.
class BvhWriter {
 public:
  /// rest: T-pose joints, metres. Throws Error when the file cannot be written or a number is not finite.
  BvhWriter(const std::string& path, const Joints& rest, double fps);
  /// Throws Error for a pose that is not finite, or when the disk is full.
  void push(const Pose& pose);
  void finish();

 private:
  PartFile file_;
  size_t count_at_ = 0;  // where the number of frames stands
  int64_t frames_ = 0;
  std::array<std::array<double, 3>, kJointCount> before_{};  // degrees
};

}  // namespace understudy
