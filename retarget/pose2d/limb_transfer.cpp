#include "retarget/pose2d/limb_transfer.hpp"

#include "retarget/pose2d/ride_along.hpp"
#include "retarget/pose2d/touches.hpp"

namespace understudy {
namespace {

/// A pose as it is being rebuilt: where points of the source go.
class Rebuilt {
 public:
  explicit Rebuilt(const FlatPose& source) : source_(source) {}
  const FlatPose& pose() const { return pose_; }

  void keep(int point) { pose_.set(point, source_.at(point), source_.confidence(point)); }
  /// `point` lies about `anchor` as in the source, so many times as far.
  void put(int point, int anchor, float ratio) {
    if (!source_.has(point) || !pose_.has(anchor)) return;
    pose_.set(point, pose_.at(anchor) + ratio * (source_.at(point) - source_.at(anchor)),
              source_.confidence(point));
  }

 private:
  const FlatPose& source_;
  FlatPose pose_;
};

/// The nearest point towards the root that is there, and the ratio of the way from it: the mean of the bones
/// between.
struct Anchor {
  int point = -1;
  float ratio = 1;
};

Anchor anchor_of(const FlatPose& pose, int point, const BoneLengths& ratio) {
  float sum = 0;
  int bones = 0;
  for (size_t b = kFlatBones.size(); b-- > 0;) {
    if (kFlatBones[b].to != point) continue;
    sum += ratio[static_cast<int>(b)], ++bones;
    point = kFlatBones[b].from;
    if (pose.has(point)) return {point, sum / static_cast<float>(bones)};
  }
  return {};
}

void put_bones(const FlatPose& source, const BoneLengths& ratio, Rebuilt& rebuilt) {
  if (source.has(body25::MidHip)) {
    rebuilt.keep(body25::MidHip);
  } else if (source.has(body25::Neck)) {
    rebuilt.keep(body25::Neck);
  } else {  // neither: the first point outwards that there is
    for (const FlatBone& bone : kFlatBones)
      if (source.has(bone.to)) {
        rebuilt.keep(bone.to);
        break;
      }
  }
  for (size_t b = 0; b < kFlatBones.size(); ++b) {
    const int point = kFlatBones[b].to;
    if (rebuilt.pose().has(point) || !source.has(point)) continue;
    Anchor anchor = anchor_of(source, point, ratio);
    if (anchor.point < 0 || !rebuilt.pose().has(anchor.point)) {
      // A limb that hangs on nothing goes with the first point that was kept.
      for (const int other : {static_cast<int>(body25::Neck), static_cast<int>(body25::RightShoulder),
                              static_cast<int>(body25::LeftShoulder), static_cast<int>(body25::RightHip),
                              static_cast<int>(body25::LeftHip)})
        if (rebuilt.pose().has(other)) {
          anchor = {other, ratio[static_cast<int>(b)]};
          break;
        }
    }
    if (anchor.point >= 0)
      rebuilt.put(point, anchor.point, anchor.ratio);
    else
      rebuilt.keep(point);
  }
}

}  // namespace

FlatPose LimbTransfer::transfer(const FlatPose& seen, const Proportions& from, const Proportions& to) {
  FlatPose source = seen;
  add_middles(source);
  const BoneLengths ratio = to.length / from.length.max(1e-6f);
  Rebuilt rebuilt(source);
  put_bones(source, ratio, rebuilt);
  FlatPose result = rebuilt.pose();
  ride_along(source, ratio, result);
  if (touches_) keep_touches(source, from.length, to.length, result);
  return result;
}

}  // namespace understudy
