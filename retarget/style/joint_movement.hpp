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

/// Causal. The pelvis is looked at without its heading.
class JointMovement {
 public:
  void reset();
  void push(const StyleFrame& frame);
  /// The slow posture.
  const Rotations& means() const { return means_; }
  /// Of the newest frame: mean * turn is the joint's rotation.
  const JointTurns& turns() const { return turns_; }
  const Mat3& heading() const { return heading_; }
  /// How far the slow posture went towards the newest frame.
  float slow_share() const { return share_; }

 private:
  SlowMean slow_;
  float share_ = 1;
  bool started_ = false;
  Rotations means_ = identity_rotations();
  JointTurns turns_{};
  Mat3 heading_ = Mat3::Identity();
};

}  // namespace understudy
