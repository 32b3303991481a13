// What an engine of styles is given: skeletons as local rotations on their own bones.
#pragma once

#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/running_median.hpp"
#include "retarget/style/pose_style.hpp"

namespace understudy {

/// The source's local rotations (CopyTransfer) on its own bone lengths, as far as they are known by then.
class StyleFrames {
 public:
  StyleFrames() { reset(); }
  void reset();
  /// Throws Error where the skeleton is not finite or has no legs.
  StyleFrame push(const Extraction& seen, float dt);

 private:
  CopyTransfer locals_;
  std::array<RunningMedian, kJointCount> lengths_;
};

}  // namespace understudy
