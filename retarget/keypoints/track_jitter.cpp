#include "retarget/keypoints/track_jitter.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace understudy {
namespace {

constexpr float kLongest = 1 / 12.0f;  // seconds between frames: a body changes more than a detector jitters
constexpr float kMemory_s = 1;
constexpr size_t kFewest = 8;               // differences of one frame
constexpr float kMedianOfNormal = 0.6745f;  // median of |x|, x standard normal
constexpr float kVarianceOfThird = 20;      // 1 + 9 + 9 + 1

}  // namespace

void TrackJitter::push(const FlatPose& seen, float dt) {
  const bool even = std::abs(dt - last_dt_) < 0.1f * dt;
  known_ = dt > kLongest ? 0 : known_ > 0 && !even ? 1 : known_;
  last_dt_ = dt;
  if (known_ == static_cast<int>(before_.size())) {
    std::vector<float> off;
    for (int point = 0; point < kBodyPoints; ++point) {
      if (!seen.has(point) || !before_[0].has(point) || !before_[1].has(point) || !before_[2].has(point))
        continue;
      const Vec2 third =
          seen.at(point) - 3 * before_[0].at(point) + 3 * before_[1].at(point) - before_[2].at(point);
      off.push_back(std::abs(third.x()));
      off.push_back(std::abs(third.y()));
    }
    if (off.size() >= kFewest) {
      const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
      std::nth_element(off.begin(), middle, off.end());
      const float now = *middle / (kMedianOfNormal * std::sqrt(kVarianceOfThird));
      seconds_ += dt;
      const float share = std::max(dt / seconds_, 1 - std::exp(-dt / kMemory_s));
      pixels_ = pixels_ < 0 ? now : pixels_ + share * (now - pixels_);
    }
  }
  before_[2] = before_[1], before_[1] = before_[0], before_[0] = seen;
  known_ = std::min(known_ + 1, static_cast<int>(before_.size()));
}

}  // namespace understudy
