#include "retarget/pose2d/proportion_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kShortest = 1e-3f, kStep = 0.03f;  // pixels; of logarithms
constexpr float kSeenAtLeast = 0.93f;              // of what was seen: detectors jitter
constexpr float kLeastDoubt = 0.02f;  // poses of one person err alike: many of them leave some doubt
constexpr uint32_t kOneIn = 50;       // longest ones are not believed

}  // namespace

void ProportionEstimate::Seen::add(float length) {
  if (!(length > kShortest)) return;
  const int bin = static_cast<int>(std::log(length / kShortest) / kStep);
  ++counts[static_cast<size_t>(std::clamp(bin, 0, kBins - 1))];
  ++all;
}

float ProportionEstimate::Seen::longest() const {
  uint32_t left = all / kOneIn;
  for (int bin = kBins - 1; bin >= 0; --bin) {
    const uint32_t here = counts[static_cast<size_t>(bin)];
    if (here > left) return kShortest * std::exp(kStep * (static_cast<float>(bin) + 0.5f));
    left -= here;
  }
  return 0;
}

void ProportionEstimate::push(const FlatPose& pose, const PoseLengths& told) {
  const BoneLengths seen = seen_lengths(pose);
  for (int b = 0; b < kFlatBoneCount; ++b) {
    seen_[static_cast<size_t>(b)].add(seen[b]);
    const double doubt = static_cast<double>(std::max(told.doubt[b], 1e-3f)), weight = 1 / (doubt * doubt);
    for (const int side : {b, kFlatBoneMirror[static_cast<size_t>(b)]}) {
      sum_[side] += weight * static_cast<double>(told.log_length[b]);
      weight_[side] += weight;
    }
  }
  ++poses_;
}

Proportions ProportionEstimate::lengths() const {
  US_CHECK(poses_ > 0, "nobody was seen whose proportions could be told");
  Proportions result;
  result.poses = poses_;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const auto mirror = static_cast<size_t>(kFlatBoneMirror[static_cast<size_t>(b)]);
    const float longest = std::max(seen_[static_cast<size_t>(b)].longest(), seen_[mirror].longest());
    result.length[b] = std::max(std::exp(static_cast<float>(sum_[b] / weight_[b])), kSeenAtLeast * longest);
    result.doubt[b] = std::max(static_cast<float>(std::sqrt(1 / weight_[b])), kLeastDoubt);
  }
  return result;
}

}  // namespace understudy
