// How far people disagree about where a point of the body is.
#pragma once

#include <array>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// Standard deviations of BODY_25's points, of the root of a person's area: COCO's, of the feet
/// COCO-WholeBody's; the neck as a shoulder, the mid-hip as a hip.
constexpr std::array<double, kBodyPoints> kPointDeviation = {
    0.026, 0.079, 0.079, 0.072, 0.062, 0.079, 0.072, 0.062, 0.107, 0.107, 0.087, 0.089, 0.107,
    0.087, 0.089, 0.025, 0.025, 0.035, 0.035, 0.068, 0.066, 0.066, 0.068, 0.066, 0.066};
/// A person's area, of the area of the box around the points.
constexpr double kAreaOfBox = 0.53;

}  // namespace understudy
