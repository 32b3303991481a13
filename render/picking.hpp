// Finds what is under the pointer. Pure functions of plain arrays.
#pragma once

#include <optional>
#include <vector>

#include "render/camera.hpp"

namespace understudy::render {

/// Where a ray enters a surface.
struct SurfaceHit {
  int face = 0;
  Vec3 barycentric = Vec3::Zero();  ///< weights of the face's corners
  int vertex = 0;                   ///< the corner nearest to the place
  float distance = 0;               ///< metres along the ray
  Vec3 position = Vec3::Zero();
};

/// The first of a mesh's triangles, seen from either side, that a ray meets. Looks at each of them, which
/// takes 0.3 ms for 26,000 and needs nothing kept for a mesh that moves.
std::optional<SurfaceHit> surface_under(const Ray& ray, const Points& vertices, const Faces& faces);

/// The point that is seen within `radius` pixels of a pixel: the one nearest to the pixel, and of those
/// equally near to within 2 pixels the one nearest to the eye. None behind the eye; points that are not
/// finite do not count.
std::optional<int> point_under(const Points& points, const Camera& camera, PixelSize size,
                               const Eigen::Vector2f& pixel, float radius);
/// The same with nothing but a ray: the point nearest to it, before its origin, within `radius` metres.
std::optional<int> point_near(const Points& points, const Ray& ray, float radius);

}  // namespace understudy::render
