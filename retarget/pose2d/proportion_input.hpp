// A 2D pose as numbers for the network that reads lengths off it.
#pragma once

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// Of each point x, y, whether it is seen and its confidence; of each bone how long it looks, and the
/// logarithm.
constexpr int kProportionInputs = 4 * kPaperPoints + 2 * kFlatBoneCount;

struct ProportionInput {
  Eigen::Matrix<float, 1, kProportionInputs> numbers;  ///< y up, from the middle of the box, of its size
  float size = 1;                                      ///< of the box around the points, its diagonal, pixels
};
/// Where neck or mid-hip are missing they are made from what they are the middle of. Throws Error when fewer
/// than two of the points are seen, all in one place, or one is not finite.
ProportionInput proportion_input(const FlatPose& pose);

}  // namespace understudy
