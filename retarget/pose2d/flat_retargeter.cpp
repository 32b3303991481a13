#include "retarget/pose2d/flat_retargeter.hpp"

#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/change_points.hpp"

namespace understudy {

FlatRetargeter::FlatRetargeter(std::unique_ptr<KeypointTransfer> engine, FlatTarget target, FlatPlace place)
    : engine_(std::move(engine)),
      target_(std::move(target)),
      place_(place),
      placement_(place == FlatPlace::Reference ? target_.standing : std::nullopt,
                 leg_of(target_.lengths.length)) {
  for (int b = 0; b < kFlatBoneCount; ++b)
    US_CHECK(target_.lengths.length[b] > 0, "the target's ", kFlatBones[static_cast<size_t>(b)].name, " is ",
             target_.lengths.length[b], " pixels long");
}

/// The target as tall as the source is in its picture.
Proportions FlatRetargeter::in_size_of(const Proportions& source) const {
  Proportions sized = target_.lengths;
  sized.length *= stature_of(source.length) / stature_of(target_.lengths.length);
  return sized;
}

/// Engines leave the hips where they are, and the neck where no hips are seen: in a film from which they come
/// and go everything would jump. So they are taken to be below the neck as they were last.
void FlatRetargeter::hang_on_lost_hips(const FlatPose& seen, float trunk_ratio, FlatPose& made) {
  FlatPose pose = seen;
  add_middles(pose);
  if (!pose.has(body25::Neck)) return;
  if (pose.has(body25::MidHip)) {
    trunk_ = pose.at(body25::MidHip) - pose.at(body25::Neck);
  } else if (trunk_ && made.has(body25::Neck)) {
    const Vec2 neck = pose.at(body25::Neck) + (1 - trunk_ratio) * *trunk_;
    const Vec2 way = neck - made.at(body25::Neck);
    change_points(made, [&](const Vec2& at) { return Vec2(at + way); });
  }
}

FlatPose FlatRetargeter::push(const CleanPose& seen, const Proportions& source, float growth) {
  US_CHECK(growth > 0, "somebody cannot be ", growth, " times as large");
  if (!seen.is_usable) return last_;
  const bool as_there = place_ == FlatPlace::Reference && target_.standing;
  const Proportions performs = as_there ? target_.lengths : in_size_of(source);
  last_ = engine_->transfer(seen.pose, source, performs);
  hang_on_lost_hips(seen.pose, performs.length[flat_bone::Trunk] / source.length[flat_bone::Trunk], last_);
  if (growth != 1) scale_pose(1 / growth, last_);
  // In the source's size legs of other proportions make steps of another length, on the source's own way.
  placement_.push(seen.pose, as_there ? leg_of(source.length) : leg_of(target_.lengths.length), last_);
  return last_;
}

}  // namespace understudy
