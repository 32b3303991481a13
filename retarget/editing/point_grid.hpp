// Points sorted into cubic cells, to find those near a place.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// Points by cell of a cubic grid, in a hash table. Points must be finite. Copies nothing but indices; keeps
/// a reference to the points.
class PointGrid {
 public:
  using Cell = Eigen::Vector3i;
  PointGrid(const Points& points, float cell_m);

  Cell cell_of(const Vec3& p) const {
    return (p * inverse_).array().floor().max(-1e6f).min(1e6f).cast<int>();
  }
  /// Number of the cell among those with points, -1 where there are none.
  int find(const Cell& cell) const;
  int cells() const { return cell_.size(); }
  const Cell& cell(int number) const { return cell_[number]; }
  /// The points in a cell, ascending.
  const int* begin(int number) const { return order_.data() + start_[number]; }
  const int* end(int number) const { return order_.data() + start_[number + 1]; }

  /// Index of the nearest point, of which there must be one; of equals the first. Quickest where it lies
  /// within `reach`.
  int nearest(const Vec3& query, float reach) const;
  /// Calls visit(index) for at least all points in the cells that a ball touches.
  template <class Visit>
  void around(const Vec3& centre, float radius, Visit&& visit) const {
    const Cell low = cell_of(centre - Vec3::Constant(radius)),
               high = cell_of(centre + Vec3::Constant(radius));
    // A ball of more cells than there are: all points, far quicker than a look into each.
    if (((high - low).cast<double>().array() + 1).prod() > cells()) {
      for (const int i : order_) visit(i);
      return;
    }
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) {
          const int number = find(Cell(x, y, z));
          if (number < 0) continue;
          for (const int* i = begin(number); i != end(number); ++i) visit(*i);
        }
  }

 private:
  size_t slot(const Cell& cell) const;

  const Points& points_;
  float inverse_;
  std::vector<int> table_;  // open addressing: number of a cell, -1 empty
  std::vector<Cell> cell_;
  std::vector<int> start_, order_;
};

}  // namespace understudy
