#include "retarget/editing/point_grid.hpp"

#include <cmath>
#include <cstdint>

#include "retarget/base/error.hpp"

namespace understudy {

PointGrid::PointGrid(const Points& points, float cell_m) : points_(points), inverse_(1 / cell_m) {
  US_CHECK(cell_m > 0 && std::isfinite(inverse_), "a grid cannot have cells of ", cell_m, " m");
  for (int i = 0; i < points.rows(); ++i) cells_[cell_of(points.row(i).transpose())].push_back(i);
}

size_t PointGrid::Hash::operator()(const Cell& cell) const {
  uint64_t h = static_cast<uint64_t>(static_cast<uint32_t>(cell.x())) * 0x9e3779b97f4a7c15ull;
  h = (h ^ static_cast<uint32_t>(cell.y())) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 29) ^ static_cast<uint32_t>(cell.z())) * 0x94d049bb133111ebull;
  return static_cast<size_t>(h >> 32);
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
