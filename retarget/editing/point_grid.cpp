#include "retarget/editing/point_grid.hpp"

#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {

PointGrid::PointGrid(const Points& points, float cell_m) : points_(points), inverse_(1 / cell_m) {
  US_CHECK(cell_m > 0 && std::isfinite(inverse_), "a grid cannot have cells of ", cell_m, " m");
  const size_t count = points.rows();
  size_t size = 16;
  while (size < 2 * count) size *= 2;
  table_.assign(size, -1);

  std::vector<int> number(count), filled;
  for (size_t i = 0; i < count; ++i) {
    const Cell cell = cell_of(points.row(i).transpose());
    const size_t at = slot(cell);
    if (table_[at] < 0) {
      table_[at] = cells();
      cell_.push_back(cell);
      filled.push_back(0);
    }
    number[i] = table_[at];
    ++filled[number[i]];
  }
  start_.assign(cell_.size() + 1, 0);
  for (size_t c = 0; c < cell_.size(); ++c) start_[c + 1] = start_[c] + filled[c];
  order_.resize(count);
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (size_t i = 0; i < count; ++i) order_[next[number[i]]++] = i;
}

size_t PointGrid::slot(const Cell& cell) const {
  uint64_t h = static_cast<uint64_t>(static_cast<uint32_t>(cell.x())) * 0x9e3779b97f4a7c15ull;
  h = (h ^ static_cast<uint32_t>(cell.y())) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 29) ^ static_cast<uint32_t>(cell.z())) * 0x94d049bb133111ebull;
  size_t at = static_cast<size_t>(h >> 32) & (table_.size() - 1);
  while (table_[at] >= 0 && cell_[table_[at]] != cell) at = (at + 1) & (table_.size() - 1);
  return at;
}

int PointGrid::find(const Cell& cell) const {
  return table_[slot(cell)];
}

int PointGrid::nearest(const Vec3& query, float reach) const {
  int best = -1;
  for (; best < 0; reach *= 2) {
    float best_distance = reach * reach;
    around(query, reach, [&](int i) {
      const float d = (points_.row(i).transpose() - query).squaredNorm();
      if (d < best_distance || (d == best_distance && (best < 0 || i < best))) best = i, best_distance = d;
    });
  }
  return best;
}

}  // namespace understudy
