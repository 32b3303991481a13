#include "retarget/keypoints/point_filter.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

// Lengths are of a person's size (a body's height, about). Tuned on projected motions of the train split, 30
// frames/s, with 15 mm of noise on each axis: jitter, 8.7 times the truth's, becomes 1.9 times, the error of
// 18.8 mm 15.6. A One-Euro filter (Casiez, Roussel, Vogel, CHI 2012) has 2.9 times the jitter at that error.
constexpr float kCalmAcceleration = 1.0f;  // per second squared
constexpr float kStartSpeed = 1.0f;        // per second: standard deviation of what is not known yet
constexpr float kCoasting = 0.15f;         // seconds: the velocity of what is not seen decays
constexpr float kShownBehind = 0.03f;  // seconds: what is shown follows the state, jitter has no way through
constexpr float kLeastSurprise = 1, kMostSurprise = 100;
constexpr float kSurpriseMemory = 0.10f;  // seconds
constexpr float kOutlierDeviations = 6, kOutlierSize = 0.12f;
constexpr float kLeastConfidence = 0.1f;

}  // namespace

Vec2 PointFilter::expected(float dt) const {
  if (unseen_ > 0) return x_ + kCoasting * (1 - std::exp(-dt / kCoasting)) * v_;
  return x_ + dt * v_;
}

bool PointFilter::is_outlier(const Vec2& seen, float dt, const Noise& noise) const {
  if (!is_alive_ || noise.smoothing <= 0) return false;
  const float off = (seen - expected(dt)).norm();
  const float spread = std::sqrt(pxx_ + 2 * dt * pxv_ + dt * dt * pvv_) + kSightingError * noise.size;
  return off > kOutlierDeviations * spread && off > kOutlierSize * noise.size;
}

Vec2 PointFilter::see(const Vec2& seen, float confidence, float dt, const Noise& noise) {
  outliers_ = 0;
  unseen_ = 0;
  confidence_ = confidence;
  const float error = kSightingError * noise.size * noise.smoothing;
  const float R = error * error / std::max(confidence, kLeastConfidence);
  if (!is_alive_ || noise.smoothing <= 0) {
    is_alive_ = true;
    x_ = shown_ = seen;
    v_.setZero();
    pxx_ = R, pxv_ = 0, pvv_ = kStartSpeed * kStartSpeed * noise.size * noise.size;
    surprise_ = 1;
    return shown_;
  }
  const float q = kCalmAcceleration * kCalmAcceleration * noise.size * noise.size * surprise_;
  x_ += dt * v_;
  pxx_ += 2 * dt * pxv_ + dt * dt * pvv_ + q * dt * dt * dt * dt / 4;
  pxv_ += dt * pvv_ + q * dt * dt * dt / 2;
  pvv_ += q * dt * dt;

  const Vec2 y = seen - x_;
  const float S = pxx_ + R;
  const float kx = pxx_ / S, kv = pxv_ / S;
  x_ += kx * y;
  v_ += kv * y;
  pvv_ -= kv * pxv_;
  pxv_ -= kx * pxv_;
  pxx_ -= kx * pxx_;

  const float keep = std::exp(-dt / kSurpriseMemory);
  const float ratio = std::min(y.squaredNorm() / (2 * S), 30.0f);
  surprise_ = std::clamp(surprise_ * (keep + (1 - keep) * ratio), kLeastSurprise, kMostSurprise);
  return show(dt, noise);
}

/// Second stage, a low-pass of its own.
Vec2 PointFilter::show(float dt, const Noise& noise) {
  if (noise.smoothing <= 0) return shown_ = x_;
  const float share = 1 - std::exp(-dt / (kShownBehind * noise.smoothing));
  shown_ += share * (x_ - shown_);
  return shown_;
}

bool PointFilter::miss(float dt, const Noise& noise) {
  if (!is_alive_) return false;
  unseen_ += dt;
  if (unseen_ > noise.gap_s) {
    reset();
    return false;
  }
  const float keep = std::exp(-dt / kCoasting);
  x_ += kCoasting * (1 - keep) * v_;
  v_ *= keep;
  const float q = kCalmAcceleration * kCalmAcceleration * noise.size * noise.size * surprise_;
  pxx_ += 2 * dt * pxv_ + dt * dt * pvv_ + q * dt * dt * dt * dt / 4;
  pxv_ += dt * pvv_ + q * dt * dt * dt / 2;
  pvv_ += q * dt * dt;
  show(dt, noise);
  return true;
}

float PointFilter::confidence(const Noise& noise) const {
  return confidence_ * std::clamp(1 - unseen_ / std::max(noise.gap_s, 1e-3f), 0.01f, 1.0f);
}

}  // namespace understudy
