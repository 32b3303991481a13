#include "retarget/metrics/inside.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/math/directions.hpp"

namespace understudy {
namespace {

constexpr int kDirections = 42;
constexpr float kReach = 0.6f;   // metres that a point sees
constexpr int kGroup = 32;       // faces, at most
constexpr float kAfar = 3;       // times a group's radius
constexpr double kUnsure = 0.1;  // that near to one half every face is looked at

/// Halves first .. last of the faces across the longest side of their box until the groups are small.
void group(const Points& middles, std::vector<int>& order, int first, int last, std::vector<int>& starts) {
  if (last - first <= kGroup) {
    starts.push_back(first);
    return;
  }
  Eigen::AlignedBox3f box;
  for (int i = first; i < last; ++i) box.extend(middles.row(order[i]).transpose());
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const int half = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + half, order.begin() + last, [&](int a, int b) {
    return std::make_pair(middles(a, axis), a) < std::make_pair(middles(b, axis), b);
  });
  group(middles, order, first, half, starts);
  group(middles, order, half, last, starts);
}

/// Share of the directions in which a point sees the cloud within kReach;
/// its points count as discs of `radius`.
/// Near 1 inside a body, well below outside.
double enclosure(const Points& cloud, const Vec3& point, float radius) {
  static const std::array<Vec3, kDirections> directions = [] {
    std::array<Vec3, kDirections> all;
    for (int i = 0; i < kDirections; ++i) all[i] = spread_direction(i, kDirections);
    return all;
  }();
  std::array<bool, kDirections> seen{};
  for (Eigen::Index i = 0; i < cloud.rows(); ++i) {
    const Vec3 offset = cloud.row(i).transpose() - point;
    const float squared = offset.squaredNorm();
    if (!(squared <= kReach * kReach)) continue;
    for (int d = 0; d < kDirections; ++d) {
      if (seen[d]) continue;
      const float along = offset.dot(directions[d]);
      seen[d] = along > 0 && squared - along * along <= radius * radius;
    }
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / kDirections;
}

/// Typical distance between neighbouring points of a cloud of two or more, metres:
/// the median over some of them.
float typical_spacing(const Points& cloud) {
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

}  // namespace

double winding_number(const Points& vertices, const Eigen::Ref<const Faces>& faces, const Vec3& point) {
  double solid_angle = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = vertices.row(faces(f, 0)).transpose() - point;
    const Vec3 b = vertices.row(faces(f, 1)).transpose() - point;
    const Vec3 c = vertices.row(faces(f, 2)).transpose() - point;
    const float la = a.norm(), lb = b.norm(), lc = c.norm();
    const float volume = a.dot(b.cross(c));
    const float denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if (volume != 0 || denominator != 0) solid_angle += 2.0 * std::atan2(volume, denominator);
  }
  return solid_angle / (4 * M_PI);
}

struct Windings::Group {
  Vec3 normal = Vec3::Zero();  // as long as its area, m^2
  Vec3 middle = Vec3::Zero();
  float radius = 0;
};

Windings::Windings(const Points& rest, Faces faces) : faces_(faces.rows(), 3) {
  Points middles(faces.rows(), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    middles.row(f) = (rest.row(faces(f, 0)) + rest.row(faces(f, 1)) + rest.row(faces(f, 2))) / 3;
  std::vector<int> order(faces.rows());
  std::iota(order.begin(), order.end(), 0);
  group(middles, order, 0, faces.rows(), first_);
  first_.push_back(faces.rows());
  for (size_t i = 0; i < order.size(); ++i) faces_.row(i) = faces.row(order[i]);
}

std::vector<bool> Windings::around(const Points& vertices, const Points& points) const {
  const std::vector<Group> groups = groups_of(vertices);
  std::vector<bool> out;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 point = points.row(i).transpose();
    double winding = at(vertices, groups, point);
    if (std::abs(winding - 0.5) < kUnsure) winding = winding_number(vertices, faces_, point);
    out.push_back(winding > 0.5);
  }
  return out;
}

std::vector<Windings::Group> Windings::groups_of(const Points& vertices) const {
  std::vector<Group> groups(first_.size() - 1);
  for (size_t g = 0; g < groups.size(); ++g) {
    Group& group = groups[g];
    float area = 0;
    for (int f = first_[g]; f < first_[g + 1]; ++f) {
      const Vec3 a = vertices.row(faces_(f, 0)), b = vertices.row(faces_(f, 1)),
                 c = vertices.row(faces_(f, 2));
      const Vec3 normal = 0.5f * (b - a).cross(c - a);
      const float own = normal.norm() + 1e-12f;  // faces without area are somewhere, too
      group.normal += normal;
      group.middle += own / 3 * (a + b + c);
      area += own;
    }
    group.middle /= area;
    for (int f = first_[g]; f < first_[g + 1]; ++f)
      for (int c = 0; c < 3; ++c)
        group.radius =
            std::max(group.radius, (vertices.row(faces_(f, c)).transpose() - group.middle).squaredNorm());
    group.radius = std::sqrt(group.radius);
  }
  return groups;
}

double Windings::at(const Points& vertices, const std::vector<Group>& groups, const Vec3& point) const {
  double winding = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    const Vec3 offset = groups[g].middle - point;
    const float far2 = offset.squaredNorm(), near = kAfar * groups[g].radius;
    if (far2 > near * near)
      winding += static_cast<double>(groups[g].normal.dot(offset) / (far2 * std::sqrt(far2))) / (4 * M_PI);
    else
      winding += winding_number(vertices, faces_.middleRows(first_[g], first_[g + 1] - first_[g]), point);
  }
  return winding;
}

double inside_share(const Mesh& scan, const Points& points) {
  US_CHECK(points.rows() > 0, "no points to evaluate");
  int inside = 0;
  if (scan.is_cloud()) {
    const Points cloud = finite_points(scan.vertices);
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
