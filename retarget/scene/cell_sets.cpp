#include "retarget/scene/cell_sets.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {

CellExtent extent_of(const Cells& cells, const CellSet& set) {
  CellExtent extent;
  for (const int c : set) {
    const Vec3 p = cells.mean(c);
    extent.low = extent.low.cwiseMin(p), extent.high = extent.high.cwiseMax(p), extent.mean += p;
  }
  extent.mean /= static_cast<float>(std::max<size_t>(set.size(), 1));
  return extent;
}

std::vector<char> flags_of(const Cells& cells, const CellSet& set) {
  std::vector<char> flags(cells.count(), 0);
  for (const int c : set) flags[c] = 1;
  return flags;
}

float gap_between(const Cells& cells, const CellSet& a, const CellSet& b, size_t most_a, size_t most_b) {
  const size_t step_a = std::max<size_t>(1, a.size() / most_a),
               step_b = std::max<size_t>(1, b.size() / most_b);
  float least = 1e9f;
  for (size_t i = 0; i < a.size(); i += step_a)
    for (size_t k = 0; k < b.size(); k += step_b)
      least = std::min(least, (cells.mean(a[i]) - cells.mean(b[k])).squaredNorm());
  return std::sqrt(least);
}

}  // namespace understudy
