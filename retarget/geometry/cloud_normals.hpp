// How dense a point cloud is, and which way its surface faces.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy {

/// About how far apart neighbouring points of a cloud are, metres; 0 for fewer than eight.
float point_spacing(const Points& points);

/// A normal for each point from its neighbours (side unknown), [N, 3]; zero where there are too few.
/// Neighbours are the points within `radius` metres; 0 picks a few times the spacing.
Points estimated_normals(const Points& points, float radius = 0);

}  // namespace understudy
