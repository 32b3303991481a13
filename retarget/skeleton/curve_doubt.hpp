// How far a smooth curve through what is known may be off.
#pragma once

#include <vector>

#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {

/// Of each frame the error that is expected of its joints on average, metres; 0 where all is known. It grows
/// with the time to the nearest known frame and with the speed about it. `curve`: the motion with its gaps
/// filled.
std::vector<float> curve_doubt(const std::vector<KnownParts>& known, const Motion& curve, const Joints& rest);

}  // namespace understudy
