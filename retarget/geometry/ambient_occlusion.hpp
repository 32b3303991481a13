// How much of the light from all around reaches each place of a surface.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy {

/// Share of an even sky all around that each vertex sees past the rest of the surface, weighted by the cosine
/// to its normal, [V] in 0..1: 1 in the open, towards 0 in folds. Light from 96 directions is tested against
/// depth maps of the surface; 13,000 vertices take about a quarter of a second. Depends on its arguments
/// alone. Throws Error when faces or normals do not fit the vertices.
Eigen::VectorXf ambient_occlusion(const Points& vertices, const Faces& faces, const Points& normals);

}  // namespace understudy
