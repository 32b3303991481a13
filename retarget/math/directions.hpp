// Unit vectors all around: at random, or evenly spread.
#pragma once

#include <cmath>

#include "retarget/base/rng.hpp"
#include "retarget/math/types.hpp"

namespace understudy {

/// A random unit vector, all alike likely.
inline Vec3 random_direction(Rng& rng) {
  Vec3 d;
  do d = Vec3(rng.normal(), rng.normal(), rng.normal());
  while (d.norm() < 1e-3f);
  return d.normalized();
}

/// Number i of `count` unit vectors that are evenly spread: a Fibonacci spiral on the sphere.
inline Vec3 spread_direction(int i, int count) {
  const float y = 1 - 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
  const float angle = 2.3999632f * static_cast<float>(i), r = std::sqrt(1 - y * y);
  return {r * std::cos(angle), y, r * std::sin(angle)};
}

}  // namespace understudy
