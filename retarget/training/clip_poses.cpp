#include "retarget/training/clip_poses.hpp"

#include <algorithm>

#include "retarget/base/index.hpp"
#include "retarget/math/types.hpp"

namespace understudy::training {

ClipPoses::ClipPoses(const std::vector<Clip>& clips) {
  for (const Clip& clip : clips) {
    auto& frames = clips_.emplace_back();
    for (const Pose& pose : clip.motion.poses) {
      Frame& frame = frames.emplace_back();
      for (int j = 0; j < kJointCount; ++j) frame.local[j] = Eigen::Quaternionf(pose.local[j]);
      frame.root = pose.root;
    }
  }
}

Pose ClipPoses::at(int clip, float frame) const {
  const auto& frames = clips_[clip];
  const int last = ssize(frames) - 1, before = std::clamp(static_cast<int>(frame), 0, std::max(0, last - 1));
  const Frame &a = frames[before], &b = frames[std::min(before + 1, last)];
  const float w = frame - static_cast<float>(before);
  Pose pose;
  for (int j = 0; j < kJointCount; ++j) {
    const float side = a.local[j].dot(b.local[j]) < 0 ? -w : w;
    pose.local[j] = Eigen::Quaternionf((1 - w) * a.local[j].coeffs() + side * b.local[j].coeffs())
                        .normalized()
                        .toRotationMatrix();
  }
  pose.root = (1 - w) * a.root + w * b.root;
  return pose;
}

}  // namespace understudy::training
