#include "retarget/discovery/rig_figures.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {

void BoneDistances::add(const SkinWeights& skin, const ScanDistances& distances) {
  constexpr float kNear = 3;  // spacings
  constexpr int kOneOf = 5;   // points that a bone moves most
  std::vector<int> own(seen_.size(), 0), shown(seen_.size(), 0);
  for (Eigen::Index i = 0; i < distances.off.size(); ++i) {
    for (int k = 0; k < kSkinBones; ++k) {
      const auto bone = static_cast<size_t>(skin.bones(i, k));
      off_[bone] += skin.weights(i, k) * distances.off[i];
      weight_[bone] += skin.weights(i, k);
    }
    const auto most = static_cast<size_t>(skin.main_bone(i));
    ++own[most];
    if (distances.off[i] <= kNear * distances.spacing_m) ++shown[most];
  }
  for (size_t bone = 0; bone < seen_.size(); ++bone)
    if (own[bone] > 0 && kOneOf * shown[bone] >= own[bone]) ++seen_[bone];
  ++frames_;
}

void BoneDistances::tell(std::vector<FoundBone>& bones) const {
  for (size_t j = 0; j < bones.size(); ++j) {
    bones[j].off_m = static_cast<float>(off_[j] / weight_[j]);
    if (frames_ > 0) bones[j].seen_share = static_cast<float>(seen_[j]) / static_cast<float>(frames_);
  }
}

void measure_motion(const RiggedMotion& performed, std::vector<FoundBone>& bones) {
  bones.resize(performed.rig.joints.size());
  for (size_t j = 0; j < bones.size(); ++j) {
    FoundBone& bone = bones[j];
    bone.turned_deg = bone.slid_m = 0;
    if (j == 0) continue;
    for (const RigPose& pose : performed.motion.poses) {
      bone.turned_deg =
          std::max(bone.turned_deg, geodesic_angle(pose.turns[j], Mat3::Identity()) * 180 / kPi);
      bone.slid_m = std::max(bone.slid_m, std::abs(pose.slides[j]));
    }
  }
}

std::vector<bool> doubted_frames(const std::vector<float>& off_m, float size_m) {
  constexpr float kMuch = 2, kMuchOfSize = 0.02f;
  std::vector<double> known;
  for (const float off : off_m)
    if (off >= 0) known.push_back(off);
  const auto share = [&](double percent) {
    return known.empty() ? 0.0f : static_cast<float>(percentile(known, percent));
  };
  const float usual = share(50), good = share(25);
  std::vector<bool> doubted;
  doubted.reserve(off_m.size());
  for (const float off : off_m)
    doubted.push_back(off < 0 || off > kMuch * usual || off > std::max(kMuch * good, kMuchOfSize * size_m));
  return doubted;
}

}  // namespace understudy
