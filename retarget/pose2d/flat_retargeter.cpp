#include "retarget/pose2d/flat_retargeter.hpp"

#include <utility>

#include "retarget/base/error.hpp"

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

FlatPose FlatRetargeter::push(const CleanPose& seen, const Proportions& source, float growth) {
  US_CHECK(growth > 0, "somebody cannot be ", growth, " times as large");
  if (!seen.is_usable) return last_;
  const bool as_there = place_ == FlatPlace::Reference && target_.standing;
  const Proportions performs = as_there ? target_.lengths : in_size_of(source);
  last_ = engine_->transfer(seen.pose, source, performs);
  if (growth != 1) scale_pose(1 / growth, last_);
  // In the source's size legs of other proportions make steps of another length, on the source's own way.
  placement_.push(seen.pose, as_there ? leg_of(source.length) : leg_of(target_.lengths.length), last_);
  return last_;
}

}  // namespace understudy
