#include "retarget/geometry/cloud_normals.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "retarget/geometry/point_tree.hpp"
#include "retarget/math/directions.hpp"

namespace understudy {
namespace {

/// Points sorted into cubes, so that the neighbours of all points of a cube lie in the 27 cubes around it.
class Cubes {
 public:
  Cubes(const Points& points, float side) : low_(points.colwise().minCoeff()), side_(side) {
    order_.reserve(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) order_.emplace_back(key_of(points.row(i)), i);
    std::sort(order_.begin(), order_.end());
    sorted_.resize(points.rows(), 3);
    for (size_t k = 0; k < order_.size(); ++k) sorted_.row(k) = points.row(order_[k].second);
  }

  size_t size() const { return order_.size(); }
  int point(size_t k) const { return order_[k].second; }  ///< the k-th in order, as the caller counts
  Vec3 position(size_t k) const { return sorted_.row(k); }
  /// One past the last point that shares a cube with the k-th.
  size_t cube_end(size_t k) const {
    const uint64_t key = order_[k].first;
    while (k < order_.size() && order_[k].first == key) ++k;
    return k;
  }

  /// The positions of all points in the 27 cubes about the k-th point's, [n, 3] one after the other.
  void gather(size_t k, std::vector<float>& around) const {
    around.clear();
    for (int64_t y = -1; y <= 1; ++y)
      for (int64_t z = -1; z <= 1; ++z) {  // three cubes along x are one run of keys
        const uint64_t first = order_[k].first + static_cast<uint64_t>(y * kStepY + z * kStepZ - 1);
        const auto begin = std::lower_bound(order_.begin(), order_.end(), std::make_pair(first, -1));
        auto end = begin;
        while (end != order_.end() && end->first <= first + 2) ++end;
        around.insert(around.end(), sorted_.data() + 3 * (begin - order_.begin()),
                      sorted_.data() + 3 * (end - order_.begin()));
      }
  }

 private:
  static constexpr int64_t kStepY = int64_t{1} << 42, kStepZ = int64_t{1} << 21;

  uint64_t key_of(const Eigen::RowVector3f& at) const {  // +1: the cube before the first has a key too
    const auto c = [&](int axis) {
      return static_cast<uint64_t>(std::min((at[axis] - low_[axis]) / side_, 1e6f)) + 1;
    };
    return c(1) << 42 | c(2) << 21 | c(0);
  }

  Eigen::RowVector3f low_;
  float side_;
  std::vector<std::pair<uint64_t, int>> order_;
  Points sorted_;
};

/// The direction in which the neighbours within `radius` of `at` spread least; zero for fewer than four.
Vec3 flattest_direction(const Vec3& at, const std::vector<float>& around, float radius) {
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0;
  int count = 0;
  for (size_t k = 0; k < around.size(); k += 3) {
    const float dx = around[k] - at.x(), dy = around[k + 1] - at.y(), dz = around[k + 2] - at.z();
    if (dx * dx + dy * dy + dz * dz > radius * radius) continue;
    xx += dx * dx, xy += dx * dy, xz += dx * dz, yy += dy * dy, yz += dy * dz, zz += dz * dz;
    x += dx, y += dy, z += dz;
    ++count;
  }
  if (count < 4) return Vec3::Zero();
  const Vec3 sum(x, y, z);
  Mat3 scatter;
  scatter << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(scatter - sum * sum.transpose() / static_cast<float>(count));
  return solver.eigenvectors().col(0);
}

constexpr int kNeighbours = 6;

/// Squared distance from point i to its sixth nearest, itself not counted.
float sixth_nearest(const Points& points, Eigen::Index i) {
  std::array<float, kNeighbours + 1> least;  // ascending; itself is among them
  least.fill(std::numeric_limits<float>::infinity());
  const float* at = points.data() + 3 * i;
  for (const float *p = points.data(), *end = p + points.size(); p != end; p += 3) {
    const float dx = p[0] - at[0], dy = p[1] - at[1], dz = p[2] - at[2], d = dx * dx + dy * dy + dz * dz;
    if (!(d < least.back())) continue;
    size_t k = least.size() - 1;
    for (; k > 0 && least[k - 1] > d; --k) least[k] = least[k - 1];
    least[k] = d;
  }
  return least.back();
}

/// What is seen of points far away along a direction, each a disc.
class DiscMap {
 public:
  DiscMap(const Points& points, float disc_m) : points_(points), disc_(disc_m) {}

  void draw(const Vec3& towards_eye) {
    const Vec3 u = towards_eye.unitOrthogonal(), v = towards_eye.cross(u);
    Mat3 axes;
    axes << u, v, towards_eye;
    seen_.noalias() = points_ * axes;
    low_ = seen_.colwise().minCoeff();
    const Eigen::RowVector3f high = seen_.colwise().maxCoeff();
    // Clouds that are thin for their size get larger discs: a map has 4 million pixels at most.
    pixel_ = std::max({disc_, (high.x() - low_.x()) / kMostSide, (high.y() - low_.y()) / kMostSide, 1e-9f});
    width_ = static_cast<int>((high.x() - low_.x()) / pixel_) + 3;
    height_ = static_cast<int>((high.y() - low_.y()) / pixel_) + 3;
    nearest_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_),
                    -std::numeric_limits<float>::infinity());
    for (Eigen::Index i = 0; i < seen_.rows(); ++i)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          float& nearest = nearest_[pixel(i, dx, dy)];
          nearest = std::max(nearest, seen_(i, 2));
        }
  }
  bool shows(Eigen::Index i) const { return nearest_[pixel(i, 0, 0)] <= seen_(i, 2) + 2.5f * pixel_; }

 private:
  static constexpr int kMostSide = 2000;
  size_t pixel(Eigen::Index i, int dx, int dy) const {
    const int x = static_cast<int>((seen_(i, 0) - low_.x()) / pixel_) + 1 + dx,
              y = static_cast<int>((seen_(i, 1) - low_.y()) / pixel_) + 1 + dy;
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }

  const Points& points_;
  float disc_, pixel_ = 0;
  Points seen_;
  Eigen::RowVector3f low_;
  int width_ = 0, height_ = 0;
  std::vector<float> nearest_;
};

}  // namespace

float point_spacing(const Points& points) {
  constexpr int kProbes = 101;
  if (points.rows() < kNeighbours + 2) return 0;
  std::vector<float> spacings;
  for (int probe = 0; probe < kProbes; ++probe) {
    const float d = sixth_nearest(points, probe * (points.rows() - 1) / (kProbes - 1));
    if (std::isfinite(d)) spacings.push_back(std::sqrt(kPi * d / (kNeighbours + 1)));
  }
  if (spacings.empty()) return 0;
  const auto middle = spacings.begin() + static_cast<long>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return *middle;
}

Points estimated_normals(const Points& points, float radius) {
  Points normals = Points::Zero(points.rows(), 3);
  if (points.rows() < 4 || !points.allFinite()) return normals;
  if (radius <= 0) radius = 3 * point_spacing(points);
  if (radius <= 0) return normals;
  const Cubes cubes(points, radius);
  std::vector<float> around;
  for (size_t begin = 0; begin < cubes.size();) {
    cubes.gather(begin, around);
    const size_t end = cubes.cube_end(begin);
    for (; begin < end; ++begin)
      normals.row(cubes.point(begin)) = flattest_direction(cubes.position(begin), around, radius);
  }
  return normals;
}

Points pointed_outwards(const Points& points, const Points& normals) {
  constexpr int kViews = 60;
  constexpr float kClear = 1;  // sum of cosines to views from which a point is seen, one side less the other
  if (points.rows() == 0) return normals;
  DiscMap map(points, point_spacing(points));
  Eigen::VectorXf seen = Eigen::VectorXf::Zero(points.rows());
  for (int view = 0; view < kViews; ++view) {
    const Vec3 towards_eye = spread_direction(view, kViews);
    map.draw(towards_eye);
    const Eigen::VectorXf cosines = normals * towards_eye;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      if (map.shows(i)) seen[i] += cosines[i];
  }
  Points pointed = normals;
  std::vector<int> clear, rest;
  for (int i = 0; i < static_cast<int>(points.rows()); ++i) {
    if (seen[i] < 0) pointed.row(i) *= -1;
    (std::abs(seen[i]) > kClear ? clear : rest).push_back(i);
  }
  if (clear.empty()) return pointed;
  const PointTree tree(points(clear, Eigen::all));
  std::vector<PointTree::Near> near;
  for (const int i : rest) {
    tree.nearest(points.row(i).transpose(), 5, near);
    float agree = 0;
    for (const PointTree::Near& n : near)
      agree += pointed.row(i).dot(pointed.row(clear[static_cast<size_t>(n.point)]));
    if (agree < 0) pointed.row(i) *= -1;
  }
  return pointed;
}

}  // namespace understudy
