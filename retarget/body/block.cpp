#include "retarget/body/block.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {

float Block::surface() const {
  return 8 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
}

Vec3 Block::sample(Rng& rng) const {
  const Vec3 areas(half.y() * half.z(), half.z() * half.x(), half.x() * half.y());
  const float pick = rng.uniform() * areas.sum();
  const int across = pick < areas[0] ? 0 : pick < areas[0] + areas[1] ? 1 : 2;
  Vec3 x;
  for (int axis = 0; axis < 3; ++axis) x[axis] = half[axis] * rng.uniform(-1, 1);
  x[across] = std::copysign(half[across], x[across]);
  return centre + axes * x;
}

/// By slabs: the stretch of the way that is between each pair of faces, from 0 to 1.
bool Block::blocks(const Vec3& from, const Vec3& to) const {
  const Vec3 a = own(from), way = own(to) - a;
  float first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(way[axis]) < 1e-9f) {
      if (std::abs(a[axis]) > half[axis]) return false;
      continue;
    }
    const float one = (-half[axis] - a[axis]) / way[axis], other = (half[axis] - a[axis]) / way[axis];
    first = std::max(first, std::min(one, other));
    last = std::min(last, std::max(one, other));
  }
  return first <= last;
}

}  // namespace understudy
