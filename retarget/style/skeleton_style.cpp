#include "retarget/style/skeleton_style.hpp"

#include <algorithm>
#include <utility>

#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/foot_contact.hpp"

namespace understudy {
Rotations by_strength(const Rotations& source, const Rotations& styled, float strength) {
  if (strength == 1) return styled;
  Rotations result;
  for (int j = 0; j < kJointCount; ++j) {
    const Vec3 turn = rotation_to_axis_angle(source[j].transpose() * styled[j]);
    result[j] = source[j] * rotation_from_axis_angle(strength * turn);
  }
  return result;
}

SkeletonStyle::SkeletonStyle(std::unique_ptr<PoseStyle> engine, float strength)
    : engine_(std::move(engine)), strength_(strength) {
  reset();
}

void SkeletonStyle::reset() {
  engine_->reset();
  frames_.reset();
  waiting_.clear();
  root_.reset();
  feet_.reset();
}

void SkeletonStyle::push(const Extraction& seen, float dt) {
  Waiting next{frames_.push(seen, dt), seen};
  engine_->push(next.frame);
  waiting_.push_back(std::move(next));
}

std::optional<Extraction> SkeletonStyle::pop() {
  const std::optional<Rotations> styled = engine_->pop();
  if (!styled) return std::nullopt;
  const Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  Pose pose;
  pose.local = by_strength(next.frame.pose.local, *styled, strength_);
  pose.root = root_.push(next.frame, pose.local);
  feet_.push(next.frame, root_.feet(), pose);
  Extraction result = exact_extraction(forward_kinematics(next.frame.rest, pose));
  result.confidence = next.seen.confidence;
  result.visibility = next.seen.visibility;
  if (next.seen.sole_height)
    result.sole_height = *next.seen.sole_height + lowest_foot(result.joints) - lowest_foot(next.seen.joints);
  return result;
}

}  // namespace understudy
