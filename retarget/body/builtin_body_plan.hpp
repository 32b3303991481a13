// From a plan of what pelvis, trunk, arms and feet do to poses: steps, and legs by inverse kinematics.
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Angles of one arm, degrees. swing: forward. raise: from hanging (0) over sideways (90) to overhead (180).
/// across: the whole arm turned towards the front when raised. turn: about the upper arm, forearm up when
/// positive.
struct ArmPlan {
  float swing = 0, raise = 12, across = 0, elbow = 15, turn = 0, wrist = 0;
};

/// What the body does at one moment besides its feet. Lengths in leg lengths / 0.8, angles in degrees.
struct TrunkPlan {
  float x = 0, z = 0;                                    ///< pelvis over the floor
  float drop = 0.02f;                                    ///< pelvis below standing height
  float yaw = 0, pitch = 0, roll = 0;                    ///< pelvis: left, forward, to the right side
  float spine_yaw = 0, spine_pitch = 0, spine_roll = 0;  ///< shared by the three joints of the spine
  float head_yaw = 0, head_pitch = 0, head_roll = 0;     ///< against the trunk
  std::array<ArmPlan, 2> arms;                           ///< left, right
};

/// A foot goes to a new place; between steps it is planted. Lengths in leg lengths / 0.8.
struct PlannedStep {
  int side;             ///< 0 left, 1 right
  float start, end;     ///< seconds
  float x, z, yaw_deg;  ///< where the ball of the foot lands
  float lift;           ///< how high on the way
  float heel_deg;       ///< heel up when it leaves
};

struct MotionPlan {
  float seconds = 4;
  std::array<Vec3, 2> feet = {Vec3(.11f, 0, 0), Vec3(-.11f, 0, 0)};  ///< at the start: x, yaw in degrees, z
  std::vector<PlannedStep> steps;                                    ///< by start, per foot
  std::function<TrunkPlan(float)> trunk;
};

/// Poses at `fps` of the person with these T-pose joints.
Motion perform(const MotionPlan& plan, const Joints& rest, float fps);

/// A smooth curve through (time, value) keys; constant outside them. Flat at each key where the values turn.
float keyed(float t, std::initializer_list<std::pair<float, float>> keys);

}  // namespace understudy
