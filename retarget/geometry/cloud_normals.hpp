// How dense a point cloud is, and which way its surface faces.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy {

/// About how far apart neighbouring points of a cloud are, metres; 0 for fewer than eight.
float point_spacing(const Points& points);

/// A normal for each point from its neighbours (side unknown), [N, 3]; zero where there are too few.
/// Neighbours are the points within `radius` metres; 0 picks a few times the spacing.
Points estimated_normals(const Points& points, float radius = 0);

/// The same normals, each pointing to the side from which its place is seen: depth maps of the cloud from all
/// around, its points as discs. Where nothing looks in, as the points about it point. Works for clouds with
/// holes; the two sides of a narrow gap face each other.
Points pointed_outwards(const Points& points, const Points& normals);

}  // namespace understudy
