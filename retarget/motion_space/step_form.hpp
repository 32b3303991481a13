// A movement as a row of numbers: paper 2's chi (section 3.1), of evenly spread knots.
#pragma once

#include "retarget/pipeline/motion_coder.hpp"

namespace understudy {

// A row is all knots' turns, then their path, then their times. Slerp between 20 knots errs by 3 mm on
// average where 100 frames were (paper 2 keeps the 100).
constexpr int kKnots = 20;
constexpr int kKnotTurns = 6 * kJointCount;      ///< of a knot: 6D forms less the identity's
constexpr int kStepTurns = kKnots * kKnotTurns;  ///< knot by knot
constexpr int kStepPath = 3 * kKnots;            ///< of the root, in leg lengths; its height is the floor's
constexpr int kStepTimes = kKnots;               ///< over kStepSeconds, so that they are 0..1
constexpr int kStepNumbers = kStepTurns + kStepPath + kStepTimes;
constexpr float kStepSeconds = 3;
constexpr float kLongestMovement = 10;  ///< seconds

using StepNumbers = Eigen::VectorXf;

/// Of a movement of the body with these T-pose joints, [kStepNumbers]: seen from its first pose, which is
/// above the origin and faces +z. Throws Error for fewer than two poses, poses that are not finite, times
/// that do not begin at 0 or do not rise, or more than kLongestMovement.
StepNumbers step_numbers(const TimedPoses& movement, const Joints& rest);

/// Writes the row of poses that are evenly spread over `seconds` and seen from the first; kKnots of them.
void put_step_numbers(const std::vector<Pose>& knots, float seconds, float leg_m, float* row);

/// The movement of such a row on the body with these T-pose joints: kKnots poses, seen from the first; times
/// begin at 0 and rise. Throws Error for another size or what is not finite.
TimedPoses movement_of_numbers(const StepNumbers& numbers, const Joints& rest);

}  // namespace understudy
