#include "retarget/style/styled_root.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr float kBearing = 0.03f;  // legs above the floor at which a point still bears a part of the body
constexpr float kLower = 0.015f;   // legs between points of which the lower one counts most
constexpr float kStands = 0.3f;    // of a point that bears all, from which the body stands
constexpr float kHeightEase_s = 0.02f;
constexpr float kPath_s = 4;  // over which styled and source's path are compared

}  // namespace

/// How much each point of the feet bears the body: 1 on the floor, less and less above it.
FootPoints<float> StyledRoot::bearing(const FootPoints<Vec3>& feet, float leg, float dt) {
  for (size_t k = 0; k < kFootPoints.size(); ++k) levels_[k].push(feet[k], leg, dt);
  // In the first frame a raised foot has no level of its own yet: both stand on one floor.
  if (!started_)
    for (const size_t k : {0, 2}) {
      levels_[k].lower_to(levels_[k + 1].height());
      levels_[k + 1].lower_to(levels_[k].height());
    }
  FootPoints<float> bears{};
  for (size_t k = 0; k < kFootPoints.size(); ++k) {
    const float above = (feet[k].y() - levels_[k].height()) / (kBearing * leg);
    bears[k] = std::exp(-0.5f * above * above);
  }
  return bears;
}

/// The way of the styled pelvis since the last frame, over the floor.
Vec3 StyledRoot::step(const StyleFrame& source, const StyledFeet& feet) {
  const Vec3 by_source = source.pose.root - last_root_;
  Vec3 by_feet = Vec3::Zero();
  float all = 0;
  for (size_t k = 0; k < kFootPoints.size(); ++k) {
    const float weight = std::min(feet.bears[k], last_.bears[k]);
    by_feet += weight * ((feet.source[k] - last_.source[k]) - (feet.styled[k] - last_.styled[k]));
    all += weight;
  }
  const float forget = std::exp(-source.dt / kPath_s), stands = std::min(1.0f, all / kStands);
  Vec3 way = by_source;
  if (way_source_ > 0.1f) way *= std::clamp(way_styled_ / way_source_, 0.5f, 2.0f);
  if (all > 1e-6f) way += stands * (by_feet / all - way);
  way_source_ = forget * way_source_ + stands * std::hypot(by_source.x(), by_source.z());
  way_styled_ = forget * way_styled_ + stands * std::hypot(way.x(), way.z());
  return {way.x(), 0, way.z()};
}

Vec3 StyledRoot::push(const StyleFrame& source, const Rotations& styled) {
  const float leg = leg_length(source.rest);
  const PosedSkeleton was = forward_kinematics(source.rest, source.pose),
                      is = forward_kinematics(source.rest, {styled, Vec3::Zero()});
  StyledFeet feet{foot_points(was.joints), foot_points(is.joints)};
  feet.bears = bearing(feet.source, leg, source.dt);
  root_ = started_ ? Vec3(root_ + step(source, feet)) : source.pose.root;

  // The lower points are as high as the source's; the lowest counts most.
  const float lowest =
      std::min({feet.source[0].y(), feet.source[1].y(), feet.source[2].y(), feet.source[3].y()});
  float over = 0, all = 0, most = 0;
  for (size_t k = 0; k < kFootPoints.size(); ++k) {
    const float weight = std::exp((lowest - feet.source[k].y()) / (kLower * leg));
    over += weight * (feet.source[k].y() - source.pose.root.y() - feet.styled[k].y());
    all += weight;
    most = std::max(most, feet.bears[k]);
  }
  const float wanted = over / all;
  offset_ =
      started_ ? offset_ + (1 - std::pow(1 - most, source.dt / kHeightEase_s)) * (wanted - offset_) : wanted;
  root_.y() = source.pose.root.y() + offset_;
  last_ = feet;
  last_root_ = source.pose.root;
  started_ = true;
  return root_;
}

}  // namespace understudy
