#include "retarget/keypoints/proportions.hpp"

namespace understudy {

BoneLengths seen_lengths(const FlatPose& pose) {
  BoneLengths length = BoneLengths::Zero();
  for (size_t b = 0; b < kFlatBones.size(); ++b) {
    const FlatBone& bone = kFlatBones[b];
    if (pose.has(bone.from) && pose.has(bone.to))
      length[static_cast<int>(b)] = (pose.at(bone.to) - pose.at(bone.from)).norm();
  }
  return length;
}

float leg_of(const BoneLengths& length) {
  using namespace flat_bone;
  return (length[RightThigh] + length[LeftThigh] + length[RightShin] + length[LeftShin]) / 2;
}

float stature_of(const BoneLengths& length) {
  constexpr float kCrownAndSoles = 1.12f;  // over nose to ankles, of the built-in body
  return kCrownAndSoles * (length[flat_bone::Trunk] + length[flat_bone::Head] + leg_of(length));
}

}  // namespace understudy
