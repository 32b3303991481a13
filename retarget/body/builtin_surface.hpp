// From an implicit body to a closed triangle mesh: marching tetrahedra, then remeshing.
#pragma once

#include <functional>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A solid that is its own mirror image in the plane x = 0, as far as the mesher needs it.
struct ImplicitSolid {
  /// about the distance in metres, negative inside; asked for x >= 0 only
  std::function<float(const Vec3&)> value;
  std::function<Vec3(const Vec3&)> warp;     ///< grid space -> space; finer where it contracts; keeps x = 0
  std::function<float(const Vec3&)> detail;  ///< factor on the edge length at a point, 1 = the coarsest
  Vec3 low, high;                            ///< box in grid space; low.x() = 0
  float cell = 0.0105f;                      ///< of the grid, metres in grid space
  float edge_length = 0.0162f;               ///< wanted where detail is 1
};

/// The solid's surface: closed, 2-manifold, outward, exactly mirrored in x = 0. The vertices of the left half
/// (x >= 0) come first; where x > 0 their mirror images follow in the same order.
Mesh polygonise(const ImplicitSolid& solid);

}  // namespace understudy
