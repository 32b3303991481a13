// Joints of a motion as a slow posture and a movement about it; what a manner changes, and what is fitted.
#pragma once

#include <array>

#include "retarget/style/pose_style.hpp"

namespace understudy {

/// The slow part of what changes: the mean of the first seconds, later an exponential one.
class SlowMean {
 public:
  explicit SlowMean(float seconds = 1.5f) : seconds_(seconds) {}
  /// The share by which the mean goes towards the newest, dt seconds after the one before.
  float share(float dt);
  void reset() { past_ = 0; }

 private:
  float seconds_, past_ = 0;
};

using JointTurns = std::array<Vec3, kJointCount>;  ///< rotation vectors, radians

/// Causal. The pelvis is looked at without its heading. Rotations are looked at as rotation vectors from the
/// T-pose, whose axes are the same in every posture: that a hand goes up as the trunk leans is so much of one
/// for so much of the other, however the arm was held before.
class JointMovement {
 public:
  void reset() { slow_.reset(), started_ = false; }
  void push(const StyleFrame& frame);
  /// The slow posture.
  const JointTurns& means() const { return means_; }
  /// Of the newest frame: rotation_from_axis_angle(mean + movement) is the joint's rotation.
  const JointTurns& movements() const { return movements_; }
  const Mat3& heading() const { return heading_; }
  /// How far the slow posture went towards the newest frame.
  float slow_share() const { return share_; }

 private:
  SlowMean slow_;
  float share_ = 1;
  bool started_ = false;
  JointTurns means_{}, movements_{};
  Mat3 heading_ = Mat3::Identity();
};

}  // namespace understudy
