// Points sorted into cubic cells, to find those near a place.
#pragma once

#include <unordered_map>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// Points by cell of a cubic grid. Points must be finite. Keeps a reference to them.
class PointGrid {
 public:
  using Cell = Eigen::Vector3i;
  PointGrid(const Points& points, float cell_m);

  Cell cell_of(const Vec3& p) const {
    return (p * inverse_).array().floor().max(-1e6f).min(1e6f).cast<int>();
  }
  struct Hash {
    size_t operator()(const Cell& cell) const;
  };
  /// The cells with points, and these, ascending.
  const std::unordered_map<Cell, std::vector<int>, Hash>& cells() const { return cells_; }

  /// Index of the nearest point, of which there must be one; of equals the first. Quickest where it lies
  /// within `reach`.
  int nearest(const Vec3& query, float reach) const;
  /// Calls visit(index) for at least all points in the cells that a ball touches.
  template <class Visit>
  void around(const Vec3& centre, float radius, Visit&& visit) const {
    const Cell low = cell_of(centre - Vec3::Constant(radius)),
               high = cell_of(centre + Vec3::Constant(radius));
    // A ball of more cells than there are: all points, far quicker than a look into each.
    if (((high - low).cast<double>().array() + 1).prod() > static_cast<double>(cells_.size())) {
      for (int i = 0; i < points_.rows(); ++i) visit(i);
      return;
    }
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z)
          if (const auto cell = cells_.find(Cell(x, y, z)); cell != cells_.end())
            for (const int i : cell->second) visit(i);
  }

 private:
  const Points& points_;
  float inverse_;
  std::unordered_map<Cell, std::vector<int>, Hash> cells_;
};

}  // namespace understudy
