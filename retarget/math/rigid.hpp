// Rigid motions: a rotation, then a translation.
#pragma once

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// x -> R x + t.
struct RigidMotion {
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();

  Vec3 operator()(const Vec3& x) const { return R * x + t; }
  Points apply(const Points& points) const {
    return (points * R.transpose()).rowwise() + Eigen::RowVector3f(t.transpose());
  }
  RigidMotion inverse() const { return {R.transpose(), -(R.transpose() * t)}; }
  /// First the right one.
  RigidMotion operator*(const RigidMotion& first) const { return {R * first.R, R * first.t + t}; }
};

/// Turned by the first half of `step` (axis-angle, world) about where `motion` takes `place`, then moved by
/// the second.
RigidMotion stepped(const RigidMotion& motion, const Vec3& place, const Vec6& step);

/// As bodies about `places` [N, 3] moved from `before` to `last`, they go on, a little slower. [N]
std::vector<RigidMotion> led_on(const std::vector<RigidMotion>& before, const std::vector<RigidMotion>& last,
                                const Points& places);

}  // namespace understudy
