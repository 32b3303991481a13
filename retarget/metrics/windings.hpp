// Many points asked of one surface whether it winds around them.
#pragma once

#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Says what winding_number() > 0.5 says, much sooner: faces that lie together are looked at together from
/// afar, as one (the first term of Barill et al. 2018), and one by one from near.
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

}  // namespace understudy
