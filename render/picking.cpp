#include "render/picking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace understudy::render {

// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, without culling.
std::optional<SurfaceHit> surface_under(const Ray& ray, const Points& vertices, const Faces& faces) {
  SurfaceHit hit;
  hit.face = -1;
  hit.distance = std::numeric_limits<float>::infinity();
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Eigen::Map<const Vec3> a(vertices.data() + 3 * faces(f, 0)), b(vertices.data() + 3 * faces(f, 1)),
        c(vertices.data() + 3 * faces(f, 2));
    const Vec3 ab = b - a, ac = c - a, p = ray.direction.cross(ac);
    const float determinant = ab.dot(p);
    if (!(std::abs(determinant) > 1e-14f)) continue;
    const Vec3 from_a = ray.origin - a, q = from_a.cross(ab);
    const float u = from_a.dot(p) / determinant, v = ray.direction.dot(q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
    const float distance = ac.dot(q) / determinant;
    if (!(distance > 0 && distance < hit.distance)) continue;
    hit.face = f;
    hit.distance = distance;
    hit.barycentric = Vec3(1 - u - v, u, v);
  }
  if (hit.face < 0) return std::nullopt;
  Eigen::Index corner = 0;
  hit.barycentric.maxCoeff(&corner);
  hit.vertex = faces(hit.face, corner);
  hit.position = ray.origin + hit.distance * ray.direction;
  return hit;
}

std::optional<int> point_under(const Points& points, const Camera& camera, PixelSize size,
                               const Eigen::Vector2f& pixel, float radius) {
  constexpr float kEqual = 2;  // pixels
  std::vector<Vec3> seen;      // pixels away, depth, index
  float nearest = radius;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 place = on_screen(camera, size, points.row(i));
    if (!place.allFinite() || (!camera.orthographic && place.z() <= 0)) continue;
    const float away = (place.head<2>() - pixel).norm();
    if (away > nearest + kEqual || away > radius) continue;
    nearest = std::min(nearest, away);
    seen.emplace_back(away, place.z(), static_cast<float>(i));
  }
  std::optional<int> best;
  float depth = std::numeric_limits<float>::infinity();
  for (const Vec3& one : seen)
    if (one.x() <= nearest + kEqual && one.y() < depth) {
      depth = one.y();
      best = static_cast<int>(one.z());
    }
  return best;
}

std::optional<int> point_near(const Points& points, const Ray& ray, float radius) {
  std::optional<int> best;
  float nearest = radius * radius;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 from = points.row(i).transpose() - ray.origin;
    const float along = from.dot(ray.direction), away = from.squaredNorm() - along * along;
    if (!(along > 0 && away <= nearest)) continue;
    nearest = away;
    best = i;
  }
  return best;
}

}  // namespace understudy::render
