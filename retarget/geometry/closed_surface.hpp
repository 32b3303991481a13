// A closed surface through points that know which way is out.
#pragma once

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Points of the surface of one body, [N, 3] metres, with unit normals outwards, about evenly spread.
struct OrientedPoints {
  Points points, normals;
};

/// A closed, smooth surface with about so many vertices, in pieces as the body is; holes are closed, pieces
/// of less than a fiftieth of the largest are left out. Screened Poisson (Kazhdan and Hoppe 2013) on a
/// regular grid, polygonised; then each vertex goes to where the points about it that face as it does have
/// the surface. The same points give the same surface. Throws Error for fewer than 30 points, and where they
/// enclose nothing.
Mesh closed_surface(const OrientedPoints& cloud, int vertices);

}  // namespace understudy
