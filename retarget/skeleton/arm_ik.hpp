// The two-bone inverse kinematics of an arm.
#pragma once

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Turns shoulder and elbow of one arm (0 left, 1 right) so that its wrist comes to `wrist` (world, metres)
/// and gives back where it came. The elbow keeps its swing plane, the hand its world rotation; see place_end.
Vec3 place_wrist(const Joints& rest, int side, const Vec3& wrist, Pose& pose);

}  // namespace understudy
