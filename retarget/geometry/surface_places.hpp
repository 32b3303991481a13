// The places of a surface that are nearest to points, told so that they stay on it when it moves.
#pragma once

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// N places on a surface, each between three of its vertices.
struct SurfacePlaces {
  Faces corners;    ///< [N, 3] vertices; of a cloud the same one thrice
  RowMatrix share;  ///< [N, 3] of each corner, not negative, rows sum to 1
  Eigen::Index size() const { return corners.rows(); }
  /// Rows [V, C] of the vertices (places, weights, ...) as they are there, [N, C].
  RowMatrix of(const RowMatrix& rows) const;
  /// Where they are on the surface with these vertices, [N, 3].
  Points on(const Points& vertices) const;
};

/// For each of `points` [N, 3] the nearest place on the faces about the vertices near it; of a cloud its
/// nearest point. Exact where faces are about as large as their neighbours. Throws Error where the surface
/// has no vertices or a point is not finite.
SurfacePlaces nearest_places(const Mesh& surface, const Points& points);

}  // namespace understudy
