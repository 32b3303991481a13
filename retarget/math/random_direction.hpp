// A way at random, all alike likely.
#pragma once

#include "retarget/base/rng.hpp"
#include "retarget/math/types.hpp"

namespace understudy {

/// Of unit length.
inline Vec3 random_direction(Rng& rng) {
  Vec3 d;
  do d = Vec3(rng.normal(), rng.normal(), rng.normal());
  while (d.norm() < 1e-3f);
  return d.normalized();
}

}  // namespace understudy
