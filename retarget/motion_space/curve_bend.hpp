// Other curves through what is known, of which a network makes other answers than the best one.
#pragma once

#include <vector>

#include "retarget/motion_space/motion_window.hpp"

namespace understudy {

constexpr int kCurveBends = 3;

/// The window with its curve bent where it is not known, in way 1 .. kCurveBends: 1 runs ahead in time and 2
/// lags behind, with legs that swing along; 3 goes to the side of the foot that is behind. By as much as
/// there is doubt: `doubt_m`, in metres, is of each sample. Low waves, 0 at what is known: half a sine from
/// one known frame to the next, a quarter of one over the first second where there is no next one. The
/// mirrored window is bent to the mirrored curve. Throws Error for another way, or where doubt_m is not as
/// long as the curve.
MotionWindow bent(MotionWindow window, int way, const std::vector<float>& doubt_m);

}  // namespace understudy
