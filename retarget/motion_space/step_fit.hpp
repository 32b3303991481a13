// A decoded movement that is fitted to what is known of a window (paper 2, sections 5 and 6).
#pragma once

#include <vector>

#include "retarget/motion_space/motion_window.hpp"
#include "retarget/pipeline/motion_coder.hpp"

namespace understudy {

struct FittedStep {
  std::vector<Pose> poses;  ///< of each sample of the window, seen from its outlook
  float error_m = 0;        ///< of the joints of wholly known samples, root mean square
};

/// The code, and the place on the floor (x, z, heading), of the movement that begins with the window, goes on
/// round by round, and comes nearest to the joints of the wholly known samples. Codes near 0 are preferred:
/// what is minimised is
///   mean |p - q|^2 / (0.005 m)^2 + |code|^2,
/// p, q known and made joints, by Levenberg's and Marquardt's steps with derivatives from differences. Of
/// the starts, which are codes, the most promising are followed, fewer in each round. Throws Error without
/// starts, or where no sample is wholly known.
FittedStep fit_step(MotionCoder& coder, const MotionWindow& window,
                    const std::vector<std::vector<float>>& starts);

}  // namespace understudy
