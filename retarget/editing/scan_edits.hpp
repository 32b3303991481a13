// Edits of a scan before joints are looked for in it: crop, floor removal, the person's cluster alone.
#pragma once

#include <optional>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/geometry/floor_plane.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A side of a box this far out, metres, is open: it cuts nothing.
constexpr float kOpenSide = 1e6f;

/// An axis-aligned box in the world, metres.
struct Box {
  Vec3 low = Vec3::Constant(-1), high = Vec3::Constant(1);
  /// All sides open.
  static Box open() { return {Vec3::Constant(-kOpenSide), Vec3::Constant(kOpenSide)}; }
  bool is_open() const { return low.maxCoeff() <= -kOpenSide && high.minCoeff() >= kOpenSide; }
  /// Side 2 * axis is the low one, 2 * axis + 1 the high one; in the order of kBoxSides.
  float& side(int i) { return (i % 2 == 0 ? low : high)[i / 2]; }
  float side(int i) const { return (i % 2 == 0 ? low : high)[i / 2]; }
  bool contains(const Vec3& point) const {
    return (point.array() >= low.array()).all() && (point.array() <= high.array()).all();
  }
};
template <class V, class S>
FieldsOf<S, Box> fields(V& visit, S& box) {
  visit("low", box.low);
  visit("high", box.high);
}
/// Around the points that are finite; none without one.
std::optional<Box> extent_of(const Points& points);
/// Around both; the other where one is none.
std::optional<Box> united(const std::optional<Box>& a, const std::optional<Box>& b);
/// What commands call a box's sides.
constexpr Names<6> kBoxSides{"low.x", "high.x", "low.y", "high.y", "low.z", "high.z"};

/// Takes the floor out and leaves the soles on it.
struct FloorCut {
  float height_m = 0;               ///< of a level floor; not used with a plane
  std::optional<FloorPlane> plane;  ///< a floor found or drawn; wins over the height
  float tolerance_m = 0.02f;        ///< what is higher above the floor is never cut
  float sole_radius_m = 0.025f;  ///< floor-high points this near, seen from above, to a body's are its soles
  float sole_band_m = 0.12f;     ///< up to this high a point is the body's that soles are under
};
template <class V, class S>
FieldsOf<S, FloorCut> fields(V& visit, S& cut) {
  visit("height_m", cut.height_m);
  visit("plane", cut.plane);
  visit("tolerance_m", cut.tolerance_m);
  visit("sole_radius_m", cut.sole_radius_m);
  visit("sole_band_m", cut.sole_band_m);
}

struct ScanEdits {
  std::optional<Box> crop;
  std::optional<FloorCut> floor;
  bool largest_cluster = false;  ///< a second person or a prop goes
  float cluster_gap_m = 0.08f;   ///< parts further apart than this are not one
  bool empty() const { return (!crop || crop->is_open()) && !floor && !largest_cluster; }
};
template <class V, class S>
FieldsOf<S, ScanEdits> fields(V& visit, S& edits) {
  visit("crop", edits.crop);
  visit("floor", edits.floor);
  visit("largest_cluster", edits.largest_cluster);
  visit("cluster_gap_m", edits.cluster_gap_m);
}

/// Without a crop that cuts nothing: what scans are made with.
ScanEdits in_effect(ScanEdits edits);

/// The scan that is left after crop, then floor, then cluster, in its old order, colours too: vertices that
/// stay, and of a mesh the faces whose three corners stay and the vertices that these use. May be empty.
/// Vertices that are not finite go with any edit. Throws Error for a crop box with no inside or sizes that
/// are not positive.
Mesh apply(const ScanEdits& edits, const Mesh& scan);

}  // namespace understudy
