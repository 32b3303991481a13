// How far two performances are apart when time does not count.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Mean angle, degrees, between the joints' rotations of both along their best monotone alignment, in which
/// each frame of either is used: dynamic time warping. Local rotations, the pelvis', which has the heading,
/// left out. At 15 frames/s. NaN where one has no frame.
double aligned_angle_deg(const std::vector<Rotations>& a, const std::vector<Rotations>& b, double fps);

}  // namespace understudy
