#include "retarget/networks/near_order.hpp"

#include <algorithm>
#include <cstdint>

namespace understudy::nn {
namespace {

/// The lowest ten bits, two zeros between each.
uint64_t spread_bits(uint32_t bits) {
  uint64_t x = bits & 0x3ff;
  x = (x | x << 16) & 0x30000ff;
  x = (x | x << 8) & 0x300f00f;
  x = (x | x << 4) & 0x30c30c3;
  return (x | x << 2) & 0x9249249;
}

}  // namespace

std::vector<int> near_order(const Points& points) {
  const Eigen::RowVector3f low = points.colwise().minCoeff();
  const float extent = (points.colwise().maxCoeff() - low).maxCoeff(), cells = extent > 0 ? 1023 / extent : 0;
  std::vector<uint64_t> keys(points.rows());
  for (size_t i = 0; i < keys.size(); ++i) {
    uint64_t place = 0;
    for (int axis = 0; axis < 3; ++axis)
      place |= spread_bits(static_cast<uint32_t>((points(i, axis) - low[axis]) * cells)) << axis;
    keys[i] = place << 32 | i;
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order(keys.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(keys[i] & 0xffffffff);
  return order;
}

}  // namespace understudy::nn
