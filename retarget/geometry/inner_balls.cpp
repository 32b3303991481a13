#include "retarget/geometry/inner_balls.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/geometry/mesh.hpp"

namespace understudy {
namespace {

constexpr int kMostRounds = 30;
constexpr int kSmoothed = 9;

/// The ball that touches p, whose normal is n, and q.
float radius_through(const Vec3& p, const Vec3& n, const Vec3& q) {
  const Vec3 inwards = p - q;
  const float along = n.dot(inwards);
  return along > 1e-9f ? inwards.squaredNorm() / (2 * along) : 0;
}

float ball_at(const PointTree& surface, const Vec3& p, const Vec3& n, float largest) {
  float radius = largest;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vec3 centre = p - radius * n;
    const PointTree::Near near = surface.nearest(centre);
    if (near.squared >= radius * radius * 0.998f) break;
    const float smaller = radius_through(p, n, surface.points().row(near.point).transpose());
    if (smaller <= 0 || smaller >= radius) break;
    radius = smaller;
  }
  return radius;
}

}  // namespace

Eigen::VectorXf inner_radii(const PointTree& surface, const Points& normals) {
  const Points& points = surface.points();
  const float largest = box_diagonal(points) / 2;
  Eigen::VectorXf raw(points.rows()), smooth(points.rows());
  for (Eigen::Index i = 0; i < raw.size(); ++i)
    raw[i] = ball_at(surface, points.row(i).transpose(), normals.row(i).transpose(), largest);
  std::vector<PointTree::Near> near;
  for (Eigen::Index i = 0; i < raw.size(); ++i) {
    surface.nearest(points.row(i).transpose(), kSmoothed, near);
    std::vector<float> radii;
    radii.reserve(near.size());
    for (const PointTree::Near& n : near) radii.push_back(raw[n.point]);
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    smooth[i] = *middle;
  }
  return smooth;
}

}  // namespace understudy
