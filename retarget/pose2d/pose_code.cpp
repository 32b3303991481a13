#include "retarget/pose2d/pose_code.hpp"

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/pose2d/seen_points.hpp"

namespace understudy {

PoseCodeInput pose_code_input(const FlatPose& seen, float stature) {
  US_CHECK(std::isfinite(stature) && stature > 0, "nobody is ", stature, " pixels tall");
  const auto [pose, box] = seen_points(seen, 2, "has no code");
  PoseCodeInput input = PoseCodeInput::Zero();
  for (int p = 0; p < kPaperPoints; ++p) {
    if (!pose.has(p)) continue;
    const Vec2 at = (pose.at(p) - box.center()) / (kPoseCodeUnit * stature);
    input.row(p) << at.x(), -at.y(), 1;
  }
  return input;
}

PersonCodeInput person_code_input(const BoneLengths& lengths) {
  US_CHECK(lengths.allFinite() && lengths.minCoeff() > 0, "a person has a length that is not above 0");
  return ((lengths / stature_of(lengths)).log() + 2).matrix().transpose();
}

}  // namespace understudy
