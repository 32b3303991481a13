#include "retarget/editing/scan_edits.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/union_find.hpp"
#include "retarget/editing/point_grid.hpp"

namespace understudy {
namespace {

using Kept = std::vector<char>;  // [V], 1 = the vertex stays

Vec3 point(const Points& points, int i) {
  return points.row(i).transpose();
}

void check(const ScanEdits& edits) {
  if (edits.crop)
    US_CHECK((edits.crop->low.array() < edits.crop->high.array()).all(), "the crop box has no inside");
  if (edits.floor) {
    const FloorCut& floor = *edits.floor;
    US_CHECK(floor.tolerance_m >= 0 && floor.sole_radius_m > 0 && floor.sole_band_m > 0,
             "the floor's tolerance and the soles' sizes must be positive");
    US_CHECK(!floor.plane || std::abs(floor.plane->normal.norm() - 1) < 1e-3f,
             "the floor's normal does not have unit length");
  }
  if (edits.largest_cluster)
    US_CHECK(edits.cluster_gap_m > 0, "the gap between clusters must be positive, not ", edits.cluster_gap_m);
}

std::vector<int> indices(const Kept& kept) {
  std::vector<int> result;
  for (size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) result.push_back(i);
  return result;
}

/// Points seen from above the floor: two directions in it, the third coordinate 0.
class FromAbove {
 public:
  explicit FromAbove(const Vec3& up) : u_(up.unitOrthogonal()), v_(up.cross(u_)) {}
  Points flat(const Points& points) const {
    Points result = Points::Zero(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      result.row(i) << points.row(i).dot(u_.transpose()), points.row(i).dot(v_.transpose()), 0;
    return result;
  }

 private:
  Vec3 u_, v_;
};

/// Takes out what is floor-high, save where a body's points are just above: those are soles.
void cut_floor(const FloorCut& cut, const Points& all, Kept& kept) {
  FloorPlane plane;
  plane.height_m = cut.height_m;
  if (cut.plane) plane = *cut.plane;
  std::vector<int> low, above;
  for (const int i : indices(kept)) {
    const float h = plane.above(point(all, i));
    if (h <= cut.tolerance_m) low.push_back(i);
    if (h > cut.tolerance_m && h <= cut.tolerance_m + cut.sole_band_m) above.push_back(i);
  }
  const FromAbove view(plane.normal);
  const Points lows = view.flat(all(low, Eigen::all)), aboves = view.flat(all(above, Eigen::all));
  const PointGrid grid(aboves, cut.sole_radius_m);
  // One stray point above the floor is noise; a foot has several.
  constexpr int kEnough = 3;
  for (size_t i = 0; i < low.size(); ++i) {
    const Vec3 at = point(lows, i);
    int near = 0;
    grid.around(at, cut.sole_radius_m, [&](int k) {
      near += (point(aboves, k) - at).squaredNorm() <= cut.sole_radius_m * cut.sole_radius_m;
    });
    if (near < kEnough) kept[low[i]] = 0;
  }
}

bool any_within(const Points& points, const std::vector<int>& a, const std::vector<int>& b, float gap) {
  for (const int i : a)
    for (const int k : b)
      if ((points.row(i) - points.row(k)).squaredNorm() <= gap * gap) return true;
  return false;
}

/// The half of the offsets between cells of side gap / sqrt(3) whose points may be within the gap, nearest
/// first.
std::vector<PointGrid::Cell> near_offsets() {
  std::vector<PointGrid::Cell> offsets;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const PointGrid::Cell c(x, y, z);
        const bool half = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
        const auto between = (c.array().abs() - 1).max(0).square().sum();
        if (half && between <= 3) offsets.push_back(c);
      }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  return offsets;
}

/// Joins all points closer than the gap, exactly: a cell's points always are (its diagonal is the gap), and
/// two cells are looked at point by point only until one pair is near enough.
void join_near(const Points& points, float gap, UnionFind& sets) {
  const PointGrid grid(points, gap / std::sqrt(3.0f) * 0.9999f);
  for (const auto& [cell, inside] : grid.cells())
    for (const int i : inside) sets.join(inside[0], i);
  for (const auto& offset : near_offsets())
    for (const auto& [cell, inside] : grid.cells()) {
      const auto other = grid.cells().find(cell + offset);
      if (other == grid.cells().end() || sets.root(inside[0]) == sets.root(other->second[0])) continue;
      if (any_within(points, inside, other->second, gap)) sets.join(inside[0], other->second[0]);
    }
}

void keep_largest(const Mesh& scan, float gap, Kept& kept) {
  const std::vector<int> which = indices(kept);
  if (which.empty()) return;
  const Points points = scan.vertices(which, Eigen::all);
  UnionFind sets(which.size());
  join_near(points, gap, sets);

  std::vector<int> position(kept.size(), -1);
  for (size_t i = 0; i < which.size(); ++i) position[which[i]] = i;
  for (Eigen::Index f = 0; f < scan.faces.rows(); ++f) {
    const int a = position[scan.faces(f, 0)];
    for (int k = 1; k < 3; ++k) {
      const int b = position[scan.faces(f, k)];
      if (a >= 0 && b >= 0) sets.join(a, b);
    }
  }

  std::vector<int> size(which.size(), 0);
  for (size_t i = 0; i < which.size(); ++i) ++size[sets.root(i)];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  for (size_t i = 0; i < which.size(); ++i)
    if (sets.root(i) != largest) kept[which[i]] = 0;
}

Kept kept_flags(const ScanEdits& edits, const Mesh& scan) {
  check(edits);
  Kept kept(scan.vertices.rows(), 1);
  for (int i = 0; i < ssize(kept); ++i) {
    const Vec3 p = point(scan.vertices, i);
    kept[i] = p.allFinite() && (!edits.crop || edits.crop->contains(p));
  }
  if (edits.floor) cut_floor(*edits.floor, scan.vertices, kept);
  if (edits.largest_cluster) keep_largest(scan, edits.cluster_gap_m, kept);
  return kept;
}

}  // namespace

std::optional<Box> extent_of(const Points& points) {
  std::optional<Box> box;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 p = points.row(i);
    if (!p.allFinite()) continue;
    box = box ? Box{box->low.cwiseMin(p), box->high.cwiseMax(p)} : Box{p, p};
  }
  return box;
}

std::optional<Box> united(const std::optional<Box>& a, const std::optional<Box>& b) {
  if (!a || !b) return a ? a : b;
  return Box{a->low.cwiseMin(b->low), a->high.cwiseMax(b->high)};
}

ScanEdits in_effect(ScanEdits edits) {
  if (edits.crop && edits.crop->is_open()) edits.crop.reset();
  return edits;
}

Mesh apply(const ScanEdits& edits, const Mesh& scan) {
  if (edits.empty()) return scan;
  return kept_part(scan, kept_flags(edits, scan));
}

}  // namespace understudy
