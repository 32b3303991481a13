#include "retarget/style/skeleton_style.hpp"

#include <algorithm>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
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
  locals_.reset(human_rest());
  for (RunningMedian& length : lengths_) length.clear();
  waiting_.clear();
  root_.reset();
}

StyleFrame SkeletonStyle::frame_of(const Extraction& seen, float dt) {
  const auto now = bone_lengths(seen.joints);
  Eigen::Array<float, kJointCount, 1> usual = now, lengths = now;
  for (int j = 1; j < kJointCount; ++j) {
    lengths_[j].push(now[j]);
    usual[j] = lengths_[j].value();
  }
  for (int j = 1; j < kJointCount; ++j) lengths[j] = 0.5f * (usual[j] + usual[kMirror[j]]);
  StyleFrame frame;
  frame.rest = rest_with_lengths(human_rest(), lengths);
  frame.pose = {locals_.push(seen, dt), seen.joints.row(Pelvis).transpose()};
  frame.dt = dt;
  return frame;
}

void SkeletonStyle::push(const Extraction& seen, float dt) {
  US_CHECK(seen.joints.allFinite() && leg_length(seen.joints) > 1e-4f,
           "the skeleton has no legs to be styled by");
  Waiting next{frame_of(seen, dt), seen};
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
  Extraction result = exact_extraction(forward_kinematics(next.frame.rest, pose));
  result.confidence = next.seen.confidence;
  result.visibility = next.seen.visibility;
  if (next.seen.sole_height)
    result.sole_height = *next.seen.sole_height + lowest_foot(result.joints) - lowest_foot(next.seen.joints);
  return result;
}

}  // namespace understudy
