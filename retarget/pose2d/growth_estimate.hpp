// How large somebody is in the picture by now: they come nearer and go away.
#pragma once

#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy {

/// Online. Each pose tells a size, foreshortened or not; what it tells is followed slowly, as nobody comes
/// nearer in a moment.
class GrowthEstimate {
 public:
  void reset() { *this = GrowthEstimate(); }
  /// told: of this pose, by a LengthReader. dt: seconds since the last pose. How many times as large the
  /// person is as `lengths` say, from a tenth to ten times.
  float push(const PoseLengths& told, const Proportions& lengths, double dt);
  /// As it was last; 1 before the first pose.
  float growth() const;

 private:
  double growth_ = 0;  // logarithm
  bool started_ = false;
};

}  // namespace understudy
