#include "retarget/metrics/surface_metrics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

void check_same_size(const Points& p, const Points& q) {
  US_CHECK(p.rows() == q.rows(), p.rows(), " predicted vertices and ", q.rows(),
           " true ones cannot be compared");
  US_CHECK(q.rows() > 0, "no vertices to compare");
}

double mean_nearest(const Points& from, const Points& to) {
  const IntMatrix nearest = nearest_neighbours(to, from, 1);
  double sum = 0;
  for (Eigen::Index i = 0; i < from.rows(); ++i)
    sum += static_cast<double>((from.row(i) - to.row(nearest(i, 0))).norm());
  return sum / static_cast<double>(from.rows());
}

double edge(const Points& x, Eigen::Index a, Eigen::Index b) {
  return (x.row(a).cast<double>() - x.row(b).cast<double>()).norm();
}

}  // namespace

double mean_vertex_error(const Points& p, const Points& q) {
  check_same_size(p, q);
  return (p.cast<double>() - q.cast<double>()).rowwise().norm().mean();
}

double chamfer_distance(const Points& p, const Points& q) {
  US_CHECK(p.rows() > 0 && q.rows() > 0, "surfaces of ", p.rows(), " and ", q.rows(),
           " points cannot be compared");
  return (mean_nearest(p, q) + mean_nearest(q, p)) / 2;
}

double aligned_vertex_error(const Points& p, const Points& q) {
  check_same_size(p, q);
  US_CHECK(q.rows() >= 3, "alignment needs at least 3 vertices, not ", q.rows());
  const Eigen::Matrix3Xd from = p.cast<double>().transpose(), to = q.cast<double>().transpose();
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, /*with_scaling=*/true);
  const Eigen::Matrix3Xd moved = (T.topLeftCorner<3, 3>() * from).colwise() + T.topRightCorner<3, 1>();
  return (moved - to).colwise().norm().mean();
}

double edge_length_error(const Points& p, const Points& q, int neighbours) {
  check_same_size(p, q);
  // One more than wanted: the vertex finds itself, though not first where vertices coincide.
  const int wanted = std::min<Eigen::Index>(neighbours + 1, q.rows());
  const auto near = nearest_neighbours(q, q, wanted);
  double sum = 0;
  int64_t edges = 0;
  for (Eigen::Index v = 0; v < q.rows(); ++v) {
    int used = 0;
    for (int i = 0; i < wanted && used < neighbours; ++i) {
      const int other = near(v, i);
      if (other == v) continue;
      sum += std::abs(edge(p, v, other) - edge(q, v, other));
      ++used;
    }
    edges += used;
  }
  return edges == 0 ? 0 : sum / static_cast<double>(edges);
}

std::optional<float> lowest_height(const Points& vertices) {
  std::optional<float> lowest;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v)
    if (vertices.row(v).allFinite() &&
        vertices(v, 1) < lowest.value_or(std::numeric_limits<float>::infinity()))
      lowest = vertices(v, 1);
  return lowest;
}

double floor_penetration(const Points& vertices) {
  US_CHECK(vertices.rows() > 0, "no vertices to evaluate");
  return std::max(0.0, -static_cast<double>(vertices.col(1).minCoeff()));
}

PartStretch::PartStretch(const Points& rest, const Faces& faces, const Joints& rest_joints) {
  const auto beyond = [&](int joint, int axis, int v) {
    const float way = rest(v, axis) - rest_joints(joint, axis);
    return rest_joints(joint, axis) < rest_joints(Pelvis, axis) ? way < 0 : way > 0;
  };
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = faces(f, k), b = faces(f, (k + 1) % 3);
      const Edge joined{a, b, edge(rest, a, b)};
      for (const int wrist : {LeftWrist, RightWrist})
        if (beyond(wrist, 0, a) && beyond(wrist, 0, b)) hands_.push_back(joined);
      if (beyond(Head, 1, a) && beyond(Head, 1, b)) head_.push_back(joined);
    }
}

double PartStretch::stretch(const std::vector<Edge>& edges, const Points& vertices) {
  double change = 0, length = 0;
  for (const Edge& joined : edges) {
    change += std::abs(edge(vertices, joined.a, joined.b) - joined.length);
    length += joined.length;
  }
  return length > 0 ? change / length : std::nan("");
}

SelfPenetration::SelfPenetration(const Points& rest, const Faces& faces, int samples)
    : faces_(faces), windings_(rest, faces) {
  US_CHECK(faces.rows() > 0, "self-penetration needs a surface, not a point cloud");
  evaluated_ = farthest_points(rest, std::min<Eigen::Index>(samples, rest.rows()));
  const std::vector<bool> inside = buried(rest);
  std::vector<int> free;
  for (size_t i = 0; i < evaluated_.size(); ++i)
    if (!inside[i]) free.push_back(evaluated_[i]);
  evaluated_ = free;
}

std::vector<bool> SelfPenetration::buried(const Points& vertices) const {
  constexpr float kAbove = 0.002f;  // metres above its own skin, where only another part's inside can be
  const Points normals = vertex_normals(vertices, faces_);
  return windings_.around(vertices,
                          vertices(evaluated_, Eigen::all) + kAbove * normals(evaluated_, Eigen::all));
}

double SelfPenetration::share(const Points& vertices) const {
  if (evaluated_.empty()) return 0;
  const std::vector<bool> inside = buried(vertices);
  return static_cast<double>(std::count(inside.begin(), inside.end(), true)) /
         static_cast<double>(inside.size());
}

}  // namespace understudy
