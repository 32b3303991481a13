// The two-bone inverse kinematics of arms and legs.
#pragma once

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Joints of one leg. side: 0 left, 1 right.
struct Leg {
  int hip, knee, ankle, ball;
  static constexpr Leg of(int side) {
    return {LeftHip + side, LeftKnee + side, LeftAnkle + side, LeftFoot + side};
  }
};

/// Turns hip and knee of one leg so that its ankle comes to `ankle` (world, metres) and gives back where it
/// came: short of it where the leg is too short, softly near full length so that the knee does not snap. The
/// knee keeps pointing where it did and the foot keeps its world rotation. An ankle that is where it should
/// be leaves the pose as it is. Analytic: law of cosines about the knee's own axis, then the smallest turn of
/// the hip.
Vec3 place_ankle(const Joints& rest, int side, const Vec3& ankle, Pose& pose);

/// The same of an arm: turns shoulder and elbow so that the wrist comes to `wrist`.
Vec3 place_wrist(const Joints& rest, int side, const Vec3& wrist, Pose& pose);

}  // namespace understudy
