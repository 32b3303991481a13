// Where a foot stands, as far as it was seen.
#pragma once

#include <algorithm>
#include <cmath>

#include "retarget/math/types.hpp"

namespace understudy {

/// The height at which a point of a foot stands: the lowest so far, forgotten slowly, and where the foot is
/// slow the one where it is. So it climbs stairs, one step after the other. Constant memory.
class FootLevel {
 public:
  void reset() { started_ = false; }
  /// point: world; leg: length of the legs, metres; dt: seconds since the one before.
  void push(const Vec3& point, float leg, float dt) {
    constexpr float kSlow = 0.3f, kSettle_s = 0.3f, kRises = 0.01f;  // legs/s; seconds; m/s
    const float speed = started_ && dt > 0 ? (point - last_).norm() / dt : 0;
    const float rise =
        speed < kSlow * leg ? (1 - std::exp(-dt / kSettle_s)) * (point.y() - height_) : kRises * dt;
    height_ = started_ ? std::min(point.y(), height_ + std::max(rise, 0.0f)) : point.y();
    last_ = point;
    started_ = true;
  }
  /// The lower of both: two feet that were not told apart yet stand on one floor.
  void lower_to(float height) { height_ = std::min(height_, height); }
  float height() const { return height_; }

 private:
  float height_ = 0;
  Vec3 last_ = Vec3::Zero();
  bool started_ = false;
};

}  // namespace understudy
