#include "retarget/keypoints/point_filter.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr float kOutlierDeviations = 6, kOutlierSize = 0.12f;
constexpr float kLeastConfidence = 0.1f;
constexpr float kLeastWay = 1e-4f;  // of sigma
constexpr float kOffMemory_s = 0.1f;

float share_of(float dt, float memory_s) {
  return 1 - std::exp(-dt / memory_s);
}

}  // namespace

Vec2 PointFilter::expected(float dt) const {
  if (unseen_ > 0) return x_ + kCoasting * share_of(dt, kCoasting) * v_;
  return x_ + dt * v_;
}

bool PointFilter::is_outlier(const Vec2& seen, float dt, const Noise& noise) const {
  if (!is_alive_ || noise.sigma <= 0) return false;
  const float off = (seen - expected(dt)).norm();
  const float spread =
      std::sqrt(2 * off_square_) * noise.sigma + kSightingError * noise.size + unseen_ * v_.norm();
  return off > kOutlierDeviations * spread && off > kOutlierSize * noise.size;
}

/// off: of sigma, as the sighting is now.
GainFeatures PointFilter::features(const Vec2& off, float sigma, float dt, const Noise& noise) const {
  const Vec2 way = dt / sigma * v_, lag = (x_ - shown_) / sigma;
  GainFeatures f;
  f << std::log1p(off.norm()), std::asinh(off.dot(off_)),
      std::asinh(off.dot(way) / std::max(way.norm(), kLeastWay)), std::asinh(off.dot(lag)),
      std::log1p(way.norm()), std::log1p(lag.norm()), std::log(sigma / noise.size) + 5, noise.unrest,
      std::exp(-kAgeScale * age_), std::log(kUsualRate * dt);
  return f;
}

Vec2 PointFilter::see(const Vec2& seen, float confidence, float dt, const Noise& noise) {
  outliers_ = 0;
  unseen_ = 0;
  confidence_ = confidence;
  if (!is_alive_ || noise.sigma <= 0) {
    reset();
    is_alive_ = true;
    confidence_ = confidence;
    return x_ = shown_ = seen;
  }
  const float sigma = noise.sigma / std::sqrt(std::max(confidence, kLeastConfidence));
  x_ += dt * v_;
  age_ += dt;
  const Vec2 off = (seen - x_) / sigma;
  const Eigen::Vector4f gains = PointGains::fitted().gains(features(off, sigma, dt, noise), memory_);
  off_ = off;
  off_square_ += share_of(dt, kOffMemory_s) * (off.squaredNorm() / 2 - off_square_);
  x_ += gains[0] * sigma * off;
  v_ += gains[1] * sigma / dt * off;
  show_gain_ = gains[2], carry_gain_ = gains[3];
  return show(dt * v_);
}

/// way: that the point has gone since the frame before, as its velocity tells.
Vec2 PointFilter::show(const Vec2& way) {
  shown_ += carry_gain_ * way;
  return shown_ += show_gain_ * (x_ - shown_);
}

bool PointFilter::miss(float dt, const Noise& noise) {
  if (!is_alive_) return false;
  unseen_ += dt;
  if (unseen_ > noise.gap_s) {
    reset();
    return false;
  }
  const Vec2 way = kCoasting * share_of(dt, kCoasting) * v_;
  x_ += way;
  v_ *= std::exp(-dt / kCoasting);
  age_ = std::max(0.0f, age_ - kForgottenUnseen * dt);
  show(way);
  return true;
}

float PointFilter::confidence(const Noise& noise) const {
  return confidence_ * std::clamp(1 - unseen_ / std::max(noise.gap_s, 1e-3f), 0.01f, 1.0f);
}

float PointFilter::unrest() const {
  return std::log1p(off_.norm());
}

}  // namespace understudy
