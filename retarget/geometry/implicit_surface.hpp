// From an implicit solid to a closed triangle mesh: marching tetrahedra, then remeshing.
#pragma once

#include <functional>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A smooth solid, as far as the mesher needs it.
struct ImplicitSolid {
  /// about the distance in metres, negative inside; of a mirrored solid asked for x >= 0 only
  std::function<float(const Vec3&)> value;
  std::function<Vec3(const Vec3&)> warp;     ///< grid space -> space; finer where it contracts; keeps x = 0
  std::function<float(const Vec3&)> detail;  ///< factor on the edge length at a point, 1 = the coarsest
  Vec3 low, high;                            ///< box in grid space, with the whole solid inside
  float cell = 0.0105f;                      ///< of the grid, metres in grid space
  float edge_length = 0.0162f;               ///< wanted where detail is 1
  int vertices = 0;      ///< about how many the mesh shall have; 0: as many as edge_length asks for
  bool mirrored = true;  ///< it is its own mirror image in the plane x = 0, where its box begins: low.x() = 0
};

/// The solid's surface: closed, 2-manifold, outward. Of a mirrored solid exactly mirrored in x = 0: the
/// vertices of the left half (x >= 0) come first; where x > 0 their mirror images follow in the same order.
/// Throws Error when there is no surface inside the box.
Mesh polygonise(const ImplicitSolid& solid);

}  // namespace understudy
