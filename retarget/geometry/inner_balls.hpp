// How thick a body is at the points of its surface.
#pragma once

#include "retarget/geometry/point_tree.hpp"

namespace understudy {

/// The radius of the largest ball that touches the surface at each of its points from inside and holds no
/// other, [N] metres (shrinking balls, Ma et al. 2012). normals [N, 3] point outwards; noise makes balls too
/// small, so each radius is the median of those at the nearest points.
Eigen::VectorXf inner_radii(const PointTree& surface, const Points& normals);

}  // namespace understudy
