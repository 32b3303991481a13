#include "retarget/style/joint_movement.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {

float SlowMean::share(float dt) {
  const float early = past_ > 0 ? dt / (past_ + dt) : 1.0f;
  past_ = std::min(past_ + std::max(dt, 1e-4f), 1e3f);
  return std::max(early, 1 - std::exp(-dt / seconds_));
}

void JointMovement::reset() {
  slow_.reset();
  started_ = false;
}

void JointMovement::push(const StyleFrame& frame) {
  using Quat = Eigen::Quaternionf;
  share_ = slow_.share(frame.dt);
  heading_ = rotation_about_y(heading_of(frame.pose.local[Pelvis]));
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3 local = j == Pelvis ? Mat3(heading_.transpose() * frame.pose.local[j]) : frame.pose.local[j];
    Mat3& mean = means_[j];
    mean = started_ ? Quat(mean).slerp(share_, Quat(local)).normalized().toRotationMatrix() : local;
    turns_[j] = rotation_to_axis_angle(mean.transpose() * local);
  }
  started_ = true;
}

}  // namespace understudy
