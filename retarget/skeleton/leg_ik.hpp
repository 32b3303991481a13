// The two-bone inverse kinematics of a leg.
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
/// came: short of it where the leg is too short. The knee keeps pointing where it did and the foot keeps its
/// world rotation; see place_end.
Vec3 place_ankle(const Joints& rest, int side, const Vec3& ankle, Pose& pose);

}  // namespace understudy
