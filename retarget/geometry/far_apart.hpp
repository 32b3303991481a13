// A few points of many that cover them well.
#pragma once

#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// At most `count` of the points `of`, far apart from each other (farthest_points from the first); [] of
/// none.
std::vector<int> far_apart(const Points& points, const std::vector<int>& of, int count);

}  // namespace understudy
