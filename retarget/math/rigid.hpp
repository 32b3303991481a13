// Rigid motions: a rotation, then a translation.
#pragma once

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

}  // namespace understudy
