#include "retarget/metrics/surface_metrics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

#include "retarget/base/error.hpp"
#include "retarget/metrics/inside.hpp"

namespace understudy {
namespace {

void check_same_size(const Points& p, const Points& q) {
  US_CHECK(p.rows() == q.rows(), p.rows(), " predicted vertices and ", q.rows(),
           " true ones cannot be compared");
  US_CHECK(q.rows() > 0, "no vertices to compare");
}

/// nanoflann's view of our points.
struct Cloud {
  const Points& points;
  size_t kdtree_get_point_count() const { return static_cast<size_t>(points.rows()); }
  float kdtree_get_pt(size_t i, size_t axis) const {
    return points(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, uint32_t>;

double edge(const Points& x, Eigen::Index a, Eigen::Index b) {
  return (x.row(a).cast<double>() - x.row(b).cast<double>()).norm();
}

}  // namespace

double mean_vertex_error(const Points& p, const Points& q) {
  check_same_size(p, q);
  return (p.cast<double>() - q.cast<double>()).rowwise().norm().mean();
}

double aligned_vertex_error(const Points& p, const Points& q) {
  check_same_size(p, q);
  US_CHECK(q.rows() >= 3, "alignment wants at least 3 vertices, not ", q.rows());
  const Eigen::Matrix3Xd from = p.cast<double>().transpose(), to = q.cast<double>().transpose();
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, /*with_scaling=*/true);
  const Eigen::Matrix3Xd moved = (T.topLeftCorner<3, 3>() * from).colwise() + T.topRightCorner<3, 1>();
  return (moved - to).colwise().norm().mean();
}

double edge_length_error(const Points& p, const Points& q, int neighbours) {
  check_same_size(p, q);
  const Cloud cloud{q};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(/*leaf_max_size=*/16));
  // One more than wanted: the vertex finds itself, though not first where vertices coincide.
  const size_t wanted = static_cast<size_t>(std::min<Eigen::Index>(neighbours + 1, q.rows()));
  std::vector<uint32_t> found(wanted);
  std::vector<float> squared(wanted);
  double sum = 0;
  int64_t edges = 0;
  for (Eigen::Index v = 0; v < q.rows(); ++v) {
    const size_t count = tree.knnSearch(q.row(v).data(), wanted, found.data(), squared.data());
    int used = 0;
    for (size_t i = 0; i < count && used < neighbours; ++i) {
      if (found[i] == static_cast<uint32_t>(v)) continue;
      sum += std::abs(edge(p, v, found[i]) - edge(q, v, found[i]));
      ++used;
    }
    edges += used;
  }
  return edges == 0 ? 0 : sum / static_cast<double>(edges);
}

double floor_penetration(const Points& vertices) {
  US_CHECK(vertices.rows() > 0, "no vertices to judge");
  return std::max(0.0, -static_cast<double>(vertices.col(1).minCoeff()));
}

SelfPenetration::SelfPenetration(const Points& rest, const Faces& faces, int samples) : faces_(faces) {
  US_CHECK(faces.rows() > 0, "self-penetration wants a surface, not a point cloud");
  judged_ = farthest_points(rest, static_cast<int>(std::min<Eigen::Index>(samples, rest.rows())));
  const std::vector<bool> inside = buried(rest);
  std::vector<int> free;
  for (size_t i = 0; i < judged_.size(); ++i)
    if (!inside[i]) free.push_back(judged_[i]);
  judged_ = free;
}

std::vector<bool> SelfPenetration::buried(const Points& vertices) const {
  constexpr float kAbove = 0.002f;  // metres above its own skin, where only another part's inside can be
  const Points normals = vertex_normals(vertices, faces_);
  std::vector<bool> result(judged_.size());
  for (size_t i = 0; i < judged_.size(); ++i) {
    const Vec3 point = (vertices.row(judged_[i]) + kAbove * normals.row(judged_[i])).transpose();
    result[i] = winding_number(vertices, faces_, point) > 0.5;
  }
  return result;
}

double SelfPenetration::share(const Points& vertices) const {
  if (judged_.empty()) return 0;
  const std::vector<bool> inside = buried(vertices);
  return static_cast<double>(std::count(inside.begin(), inside.end(), true)) /
         static_cast<double>(inside.size());
}

}  // namespace understudy
