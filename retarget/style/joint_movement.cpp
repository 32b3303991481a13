#include "retarget/style/joint_movement.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kFirst_s = 1 / 30.0f;  // what the first frame counts, before which there is none

}  // namespace

float SlowMean::share(float dt) {
  if (past_ == 0) dt = std::max(dt, kFirst_s);
  const float early = past_ > 0 ? dt / (past_ + dt) : 1.0f;
  past_ = std::min(past_ + std::max(dt, 1e-4f), 1e3f);
  return std::max(early, 1 - std::exp(-dt / seconds_));
}

void JointMovement::push(const StyleFrame& frame) {
  share_ = slow_.share(frame.dt);
  heading_ = rotation_about_y(heading_of(frame.pose.local[Pelvis]));
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3 local = j == Pelvis ? Mat3(heading_.transpose() * frame.pose.local[j]) : frame.pose.local[j];
    const Vec3 turn = rotation_to_axis_angle(local);
    if (!started_) means_[j] = movements_[j] = turn;
    // The vector of the same rotation that goes on from the slow posture.
    const float angle = turn.norm();
    const Vec3 other = angle > 1e-3f ? Vec3((1 - 2 * kPi / angle) * turn) : turn;
    const Vec3 now = (other - means_[j]).squaredNorm() < (turn - means_[j]).squaredNorm() ? other : turn;
    means_[j] += share_ * (now - means_[j]);
    movements_[j] = now - means_[j];
  }
  started_ = true;
}

}  // namespace understudy
