// What lies near a place, among points in cubes.
#pragma once

#include <optional>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// Points of a cloud that lie in a box, sorted into cubes. Built in linear time for each frame's scan.
class NearPoints {
 public:
  /// Those of `points` in the box from `low` to `high`, metres; others, and those that are not finite, are
  /// never found. `reach`: how far away points are looked for. Throws Error for a reach that is not positive
  /// or a box that is not finite.
  NearPoints(const Points& points, const Vec3& low, const Vec3& high, float reach);

  /// The point nearest to `at` within the reach.
  std::optional<Vec3> nearest(const Vec3& at) const;
  /// All points within `radius` of `at`, not beyond the reach; `found` is emptied first.
  void within(const Vec3& at, float radius, std::vector<Vec3>& found) const;
  /// How many points are in the box.
  int size() const { return static_cast<int>(sorted_.size()); }
  /// Any of them, in the order of the cubes.
  const Vec3& operator[](int i) const { return sorted_[static_cast<size_t>(i)]; }

 private:
  using Place = Eigen::Vector3i;
  Place place_of(const Vec3& at) const { return ((at - low_) * inverse_).array().floor().cast<int>(); }
  size_t cube(const Place& place) const {
    return (static_cast<size_t>(place.z()) * counts_.y() + place.y()) * counts_.x() + place.x();
  }
  template <typename Visit>
  void visit(const Vec3& at, const float& reach2, Visit&& visit) const;

  Vec3 low_;
  float reach_, inverse_;
  Place counts_;
  std::vector<int> begin_;  // of each cube in sorted_, and the end of the last
  std::vector<Vec3> sorted_;
};

/// The direction in which points spread least, and by what share of the next: 0 for a plane. None for fewer
/// than six.
struct Facing {
  Vec3 normal;
  float thickness;  ///< variance along the normal over that along the second axis
};
std::optional<Facing> facing(const std::vector<Vec3>& points);

}  // namespace understudy
