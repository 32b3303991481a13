// Inverse kinematics of two bones and the hinge between them: what legs and arms share.
#pragma once

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

struct TwoBones {
  int upper, hinge, end;  ///< joints, parent first
  Vec3 axis;              ///< about which the hinge bends near the T-pose, in T-pose axes
};

/// Turns the upper joint and the hinge so that the end comes to `wanted` (world, metres) and gives back where
/// it came: short of it where the limb is too short, softly near full length so that the hinge does not snap.
/// The hinge keeps pointing where it did and the end keeps its world rotation. An end that is where it should
/// be leaves the pose as it is. Analytic: law of cosines about the hinge's own axis, then the smallest turn
/// of the upper joint.
Vec3 place_end(const Joints& rest, const TwoBones& limb, const Vec3& wanted, Pose& pose);

}  // namespace understudy
