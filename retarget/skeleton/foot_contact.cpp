#include "retarget/skeleton/foot_contact.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {

namespace {
constexpr float kSettle = 0.02f;  // seconds: differences of frames at high rates are mostly noise
}

ContactSwitch::ContactSwitch(const FootContactOptions& options, float leg_m)
    : options_(options), scale_(std::max(leg_m, 1e-3f) / 0.8f) {}

bool ContactSwitch::push(const Vec3& position, float standing_height, float dt) {
  const float height = (position.y() - standing_height) / scale_;
  if (!started_) velocity_.setZero();
  if (started_ && dt > 0) velocity_ += (1 - std::exp(-dt / kSettle)) * ((position - last_) / dt - velocity_);
  on_ = on_ ? height < options_.end_height_m && speed() < options_.end_speed
            : height < options_.begin_height_m && speed() < options_.begin_speed;
  last_ = position;
  started_ = true;
  return on_;
}

}  // namespace understudy
