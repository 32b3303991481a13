#include "retarget/metrics/windings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "retarget/metrics/inside.hpp"

namespace understudy {
namespace {

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

}  // namespace

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
    const Vec3 way = groups[g].middle - point;
    const float far2 = way.squaredNorm(), near = kAfar * groups[g].radius;
    if (far2 > near * near)
      winding += static_cast<double>(groups[g].normal.dot(way) / (far2 * std::sqrt(far2))) / (4 * M_PI);
    else
      winding += winding_number(vertices, faces_.middleRows(first_[g], first_[g + 1] - first_[g]), point);
  }
  return winding;
}

}  // namespace understudy
