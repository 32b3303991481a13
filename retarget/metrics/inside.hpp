// Whether a point is inside a surface, also where the surface has holes or is only points.
#pragma once

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Generalised winding number of a triangle mesh around a point: 1 inside, 0 outside, between near holes
/// (Jacobson et al. 2013; solid angles after van Oosterom and Strackee 1983).
double winding_number(const Points& vertices, const Eigen::Ref<const Faces>& faces, const Vec3& point);

/// Share of 42 directions, evenly spread, in which a point sees the cloud within `reach` metres; the points
/// count as discs of `radius`. Near 1 inside a body, well below outside.
double enclosure(const Points& cloud, const Vec3& point, float radius, float reach = 0.6f);

/// Typical distance between neighbouring points of a cloud, metres: the median over some of them. 2 points or
/// more.
float typical_spacing(const Points& cloud);

/// Share of `points` inside the scan: by winding number for a mesh, by enclosure for a cloud, of which
/// rows that are not finite are ignored.
double inside_share(const Mesh& scan, const Points& points);

}  // namespace understudy
