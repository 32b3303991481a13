#include "retarget/pipeline/pose_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

// On dev clips, with a degree and 5 mm of noise a frame, these err least, or nearly, after 3 to 15 frames.
constexpr float kRest_s = 0.15f;      // in which joints lose most of their speed
constexpr float kMean_s = 0.04f;      // over which a speed is averaged: one frame's is mostly noise
constexpr float kForgotten_s = 0.3f;  // after so long without a frame its speed is not known

/// Of a body that walks on: seconds' worth of its speed. It slows down gently and stands after kLongest_s.
float way_of_root(float seconds) {
  const float share = seconds / PosePrediction::kLongest_s;
  return seconds * (1 - share * share * share / 4);
}

}  // namespace

void PosePrediction::push(const Pose& pose, const Standing& standing, float dt) {
  if (!last_ || !(dt > 0) || dt > kForgotten_s) {
    speed_.reset();
  } else {
    Speed now;
    for (size_t j = 0; j < kJointCount; ++j)
      now.turn[j] = rotation_to_axis_angle(last_->local[j].transpose() * pose.local[j]) / dt;
    now.root = (pose.root - last_->root) / dt;
    const float share = speed_ ? dt / (dt + kMean_s) : 1;
    if (!speed_) speed_ = now;
    for (size_t j = 0; j < kJointCount; ++j) speed_->turn[j] += share * (now.turn[j] - speed_->turn[j]);
    speed_->root += share * (now.root - speed_->root);
  }
  last_ = pose;
  standing_ = standing;
}

float PosePrediction::doubt_m(float seconds) {
  constexpr float kFound_m_s = 0.45f;  // dev's walks and runs: 48, 126, 198 mm after 0.1, 0.27, 0.5 s
  return kFound_m_s * seconds;
}

Pose PosePrediction::after(float seconds, const Joints& rest) const {
  US_CHECK(last_, "there is no frame that a prediction could go on from");
  if (!speed_) return *last_;
  seconds = std::clamp(seconds, 0.0f, kLongest_s);
  const float way = kRest_s * (1 - std::exp(-seconds / kRest_s));
  Pose pose = *last_;
  pose.root += way_of_root(seconds) * speed_->root;
  for (size_t j = 0; j < kJointCount; ++j)
    pose.local[j] = pose.local[j] * rotation_from_axis_angle(way * speed_->turn[j]);
  const Joints stood = forward_kinematics(rest, *last_).joints;
  for (int side = 0; side < 2; ++side)
    if (standing_[side]) place_ankle(rest, side, stood.row(Leg::of(side).ankle).transpose(), pose);
  return pose;
}

}  // namespace understudy
