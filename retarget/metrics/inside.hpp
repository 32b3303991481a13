// Whether a point is inside a surface, also where the surface has holes or is only points.
#pragma once

#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Generalised winding number of a triangle mesh around a point: 1 inside, 0 outside, between near holes
/// (Jacobson et al. 2013; solid angles after van Oosterom and Strackee 1983).
double winding_number(const Points& vertices, const Eigen::Ref<const Faces>& faces, const Vec3& point);

/// Whether winding_number() > 0.5, much sooner: faces that lie together are one from afar (the first term of
/// Barill et al. 2018), and are looked at one by one from near.
class Windings {
 public:
  /// Faces are grouped as they lie in this pose; they need not stay closed or in one piece.
  Windings(const Points& rest, Faces faces);
  /// Of each of `points` [P, 3] whether the surface with these vertices, in any pose, winds around it.
  std::vector<bool> around(const Points& vertices, const Points& points) const;

 private:
  struct Group;
  std::vector<Group> groups_of(const Points& vertices) const;
  double at(const Points& vertices, const std::vector<Group>& groups, const Vec3& point) const;

  Faces faces_;             // those of a group one after the other
  std::vector<int> first_;  // of each group, and the end
};

/// Share of `points` inside the scan: by winding number for a mesh, for a cloud, of which rows that are not
/// finite are ignored, by the share of 42 directions, evenly spread, in which a point sees it within 0.6 m.
double inside_share(const Mesh& scan, const Points& points);

}  // namespace understudy
