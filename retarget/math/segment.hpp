// Points beside segments.
#pragma once

#include <algorithm>

#include "retarget/math/types.hpp"

namespace understudy {

/// Where on the segment from a to b the point nearest to p lies: 0 at a, 1 at b.
inline float along_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  return std::clamp((p - a).dot(along) / std::max(along.squaredNorm(), 1e-12f), 0.0f, 1.0f);
}

/// The vector to p from the point of the segment that is nearest to it.
inline Vec3 from_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return p - a - along_segment(p, a, b) * (b - a);
}

}  // namespace understudy
