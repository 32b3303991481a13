#include "retarget/metrics/inside.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/geometry/finite_rows.hpp"

namespace understudy {
namespace {

constexpr int kDirections = 42;

/// Directions evenly spread over the sphere, on a golden spiral.
std::array<Vec3, kDirections> spread_directions() {
  std::array<Vec3, kDirections> directions;
  const float golden = kPi * (3.0f - std::sqrt(5.0f));
  for (int i = 0; i < kDirections; ++i) {
    const float y = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / kDirections, r = std::sqrt(1.0f - y * y);
    directions[i] = {r * std::cos(golden * static_cast<float>(i)), y,
                     r * std::sin(golden * static_cast<float>(i))};
  }
  return directions;
}

}  // namespace

double winding_number(const Points& vertices, const Eigen::Ref<const Faces>& faces, const Vec3& point) {
  double solid_angle = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = vertices.row(faces(f, 0)).transpose() - point;
    const Vec3 b = vertices.row(faces(f, 1)).transpose() - point;
    const Vec3 c = vertices.row(faces(f, 2)).transpose() - point;
    const float la = a.norm(), lb = b.norm(), lc = c.norm();
    const float volume = a.dot(b.cross(c));
    const float spread = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if (volume != 0 || spread != 0) solid_angle += 2.0 * std::atan2(volume, spread);
  }
  return solid_angle / (4 * M_PI);
}

double enclosure(const Points& cloud, const Vec3& point, float radius, float reach) {
  static const std::array<Vec3, kDirections> directions = spread_directions();
  std::array<bool, kDirections> seen{};
  for (Eigen::Index i = 0; i < cloud.rows(); ++i) {
    const Vec3 offset = cloud.row(i).transpose() - point;
    const float squared = offset.squaredNorm();
    if (!(squared <= reach * reach)) continue;
    for (int d = 0; d < kDirections; ++d) {
      if (seen[d]) continue;
      const float along = offset.dot(directions[d]);
      seen[d] = along > 0 && squared - along * along <= radius * radius;
    }
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / kDirections;
}

float typical_spacing(const Points& cloud) {
  US_CHECK(cloud.rows() >= 2, "spacing wants at least 2 points, not ", cloud.rows());
  const Eigen::Index step = std::max<Eigen::Index>(1, cloud.rows() / 50);
  std::vector<float> nearest;
  for (Eigen::Index i = 0; i < cloud.rows(); i += step) {
    Eigen::ArrayXf squared = (cloud.rowwise() - cloud.row(i)).rowwise().squaredNorm().array();
    squared[i] = squared[i == 0 ? 1 : 0];
    nearest.push_back(squared.minCoeff());
  }
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<long>(nearest.size() / 2), nearest.end());
  return std::sqrt(nearest[nearest.size() / 2]);
}

double inside_share(const Mesh& scan, const Points& points) {
  US_CHECK(points.rows() > 0, "no points to evaluate");
  int inside = 0;
  if (scan.is_cloud()) {
    const Points cloud = finite_rows(scan.vertices);
    if (cloud.rows() < 2) return 0;
    const float radius = 3 * typical_spacing(cloud);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      inside += enclosure(cloud, points.row(i).transpose(), radius) > 0.8;
  } else {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      inside += winding_number(scan.vertices, scan.faces, points.row(i).transpose()) > 0.5;
  }
  return static_cast<double>(inside) / static_cast<double>(points.rows());
}

}  // namespace understudy
