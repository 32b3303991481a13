// A coder without a network: a few moments of a movement, and how long it takes.
#pragma once

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/motion_coder.hpp"

namespace understudy::tests {

/// Legs and upper arms at six moments, the pelvis' places, and the duration.
class PlainCoder final : public MotionCoder {
 public:
  explicit PlainCoder(float scale = 1) : scale_(scale) {}
  int size() const override { return kMoments * kEach + 1; }
  MotionCode encode(const TimedPoses& movement, const Joints&) override {
    US_CHECK(movement.poses.size() > 1, "a movement of ", movement.poses.size(), " poses");
    MotionCode code;
    code.mean.push_back(scale_ * movement.duration());
    for (int k = 0; k < kMoments; ++k) {
      const Pose pose = pose_at(movement, movement.duration() * static_cast<float>(k) / (kMoments - 1));
      for (int i = 0; i < 3; ++i) code.mean.push_back(scale_ * pose.root[i]);
      for (const int joint : kCoded) {
        const Vec3 turn = rotation_to_axis_angle(pose.local[static_cast<size_t>(joint)]);
        for (int i = 0; i < 3; ++i) code.mean.push_back(scale_ * turn[i]);
      }
    }
    return code;
  }
  TimedPoses decode(const std::vector<float>& code, const Joints&) override {
    US_CHECK(static_cast<int>(code.size()) == size(), "a code of ", code.size(), " numbers");
    TimedPoses movement;
    for (int k = 0; k < kMoments; ++k) {
      const float* at = code.data() + 1 + k * kEach;
      Pose pose;
      pose.root = Vec3(at[0], at[1], at[2]) / scale_;
      for (const int joint : kCoded) {
        at += 3;
        pose.local[static_cast<size_t>(joint)] = rotation_from_axis_angle(Vec3(at[0], at[1], at[2]) / scale_);
      }
      movement.poses.push_back(pose);
      movement.seconds.push_back(code[0] / scale_ * static_cast<float>(k) / (kMoments - 1));
    }
    return movement;
  }
  std::string name() const override { return "paper"; }  // stands for the learned one

 private:
  static constexpr int kCoded[] = {LeftHip, RightHip, LeftKnee, RightKnee, LeftShoulder, RightShoulder};
  static constexpr int kMoments = 6, kEach = 3 + 3 * 6;
  float scale_;
};

}  // namespace understudy::tests
