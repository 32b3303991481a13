#include "retarget/keypoints/track_noise.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr float kSizeMemory_s = 1;
constexpr float kUnknownSigma = 0.004f, kLeastSigma = 0.0008f, kMostSigma = 0.016f;  // of the size

}  // namespace

void TrackNoise::push(const FlatPose& seen, float dt) {
  jitter_.push(seen, dt);
  const float now = size_of(seen);
  if (now <= 0) return;
  // A body seems small for a while, never large.
  const float share = now > size_ ? 0.5f : 1 - std::exp(-dt / kSizeMemory_s);
  size_ = size_ <= 0 ? now : size_ + share * (now - size_);
}

float TrackNoise::sigma() const {
  const float size = std::max(size_, 1.0f), seen = jitter_.pixels();
  return seen < 0 ? kUnknownSigma * size : std::clamp(seen, kLeastSigma * size, kMostSigma * size);
}

}  // namespace understudy
