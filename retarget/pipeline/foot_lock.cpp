#include "retarget/pipeline/foot_lock.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

// Where a foot stands is learnt: it follows what is lower within kLevelFall, a slow foot not far above it
// within kLevelSettle (seconds), and rises by kLevelRise (m/s) in any case.
constexpr float kLevelFall = 0.2f, kLevelSettle = 0.3f, kLevelRise = 0.01f;
constexpr float kLevelReach = 0.06f;  // metres, leg 0.8 m
constexpr std::array<int, 4> kFootPoints = {LeftAnkle, RightAnkle, LeftFoot, RightFoot};

Vec3 over_floor(const Vec3& v) {
  return Vec3(v.x(), 0, v.z());
}

}  // namespace

void FootLock::start(const Joints& source) {
  const float leg_m = leg_length(source);
  for (size_t k = 0; k < kFootPoints.size(); ++k) {
    switches_[k] = ContactSwitch(options_.contact, leg_m);
    levels_[k] = source(kFootPoints[k], 1);
  }
  offset_.fill(Vec3::Zero());
  standing_.fill(false);
  started_ = true;
}

std::array<bool, 4> FootLock::contacts(const Joints& source, float dt) {
  std::array<bool, 4> on{};
  const float leg_m = leg_length(source);
  for (size_t k = 0; k < kFootPoints.size(); ++k) {
    const Vec3 point = source.row(kFootPoints[k]).transpose();
    const float above = point.y() - levels_[k];
    const bool settling =
        above < kLevelReach * leg_m / 0.8f && switches_[k].speed() < options_.contact.begin_speed;
    if (above < 0 || settling)
      levels_[k] += (1 - std::exp(-dt / (above < 0 ? kLevelFall : kLevelSettle))) * above;
    else
      levels_[k] += std::min(kLevelRise * dt, above);
    on[k] = switches_[k].push(point, levels_[k], dt);
  }
  return on;
}

Pose FootLock::push(const Pose& pose, const Joints& rest, float dt, const Joints& source, Standing seen) {
  US_CHECK(source.allFinite(), "the source's joints are not finite");
  const bool first = !started_;
  if (first) start(source);
  const std::array<bool, 4> on = contacts(source, dt);
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  const float leg_m = leg_length(rest);

  Pose result = pose;
  for (int side = 0; side < 2; ++side) {
    const size_t s = side;
    const Leg leg = Leg::of(side);
    const bool on_heel = seen[s] && on[s], on_ball = seen[s] && on[s + 2];
    const Vec3 ankle = posed.joints.row(leg.ankle).transpose(), ball = posed.joints.row(leg.ball).transpose();
    const Vec3 heel_offset(0, rest(leg.ball, 1) - rest(leg.ankle, 1), -0.06f * leg_m);
    const Vec3 heel = ankle + posed.global[leg.ankle] * heel_offset;
    const bool stood = standing_[s];
    standing_[s] = on_heel || on_ball;
    Vec3& offset = offset_[s];
    if (!first && stood && standing_[s]) {
      const bool rolls_on_ball = on_ball && (stood_on_ball_[s] || !on_heel);
      offset += over_floor(rolls_on_ball ? last_ball_[s] - ball : last_heel_[s] - heel);
      const float limit = options_.max_offset_m * leg_m / 0.8f;
      if (offset.norm() > limit) offset *= limit / offset.norm();
    } else {
      offset *= std::exp(-dt / std::max(options_.release_s, 1e-3f));
    }
    if (standing_[s]) offset *= std::exp(-dt / std::max(options_.creep_s, 1e-3f));
    stood_on_ball_[s] = on_ball;
    last_ball_[s] = ball;
    last_heel_[s] = heel;
    if (offset.norm() > 1e-5f) place_ankle(rest, side, ankle + offset, result);
  }
  return result;
}

}  // namespace understudy
