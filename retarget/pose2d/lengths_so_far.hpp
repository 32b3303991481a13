// A person's lengths while their poses come.
#pragma once

#include "retarget/pose2d/proportion_estimate.hpp"

namespace understudy {

/// Online. Lengths are made out anew ever more seldom: that takes longer than lifting a pose.
class LengthsSoFar {
 public:
  /// From this pose and those before. Throws Error as the reader does.
  const BoneLengths& push(const FlatPose& pose, const LengthReader& reader);

 private:
  ProportionEstimate estimate_;
  BoneLengths lengths_ = BoneLengths::Ones();
  int next_ = 1;  // poses, with which they are made out anew
};

}  // namespace understudy
