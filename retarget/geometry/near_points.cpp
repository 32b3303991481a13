#include "retarget/geometry/near_points.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr int kMostCubes = 160;  // along an axis: larger boxes get larger cubes
constexpr size_t kFewestFacing = 6;

}  // namespace

NearPoints::NearPoints(const Points& points, const Vec3& low, const Vec3& high, float reach)
    : low_(low), reach_(reach) {
  const Vec3 extent = high - low;
  US_CHECK(reach > 0 && low.allFinite() && high.allFinite() && extent.minCoeff() >= 0,
           "points cannot be sought within ", reach, " m");
  inverse_ = 1 / std::max(reach, extent.maxCoeff() / static_cast<float>(kMostCubes));
  counts_ = place_of(high).array() + 1;

  std::vector<int> cube_of(points.rows(), -1);
  begin_.assign(static_cast<size_t>(counts_.x()) * counts_.y() * counts_.z() + 1, 0);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 at = points.row(i);
    const bool inside = (at.array() >= low.array()).all() && (at.array() <= high.array()).all();  // not NaN
    if (!inside) continue;
    cube_of[i] = static_cast<int>(cube(place_of(at)));
    ++begin_[cube_of[i] + 1];
  }
  for (size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  sorted_.resize(begin_.back());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (cube_of[i] >= 0) sorted_[next[cube_of[i]]++] = points.row(i);
}

/// The points in the 27 cubes about a place, nearest rows first: runs of three cubes along x lie one after
/// the other. `reach2`, squared metres, may shrink on the way; rows beyond it are left out.
template <typename Visit>
void NearPoints::visit(const Vec3& at, const float& reach2, Visit&& visit) const {
  const Vec3 scaled = (at - low_) * inverse_;
  if (!(scaled.cwiseAbs().maxCoeff() < 2 * kMostCubes)) return;  // NaN, too
  const Place middle = scaled.array().floor().cast<int>();
  const int first = std::max(0, middle.x() - 1), last = std::min(counts_.x() - 1, middle.x() + 1);
  if (first > last) return;
  constexpr int kSteps[] = {0, -1, 1};
  const auto gap = [&](int axis, int step) {  // to the cubes a step away
    const float inside = scaled[axis] - static_cast<float>(middle[axis]);
    return (step == 0 ? 0 : step < 0 ? inside : 1 - inside) / inverse_;
  };
  for (const int dz : kSteps)
    for (const int dy : kSteps) {
      const int y = middle.y() + dy, z = middle.z() + dz;
      if (y < 0 || z < 0 || y >= counts_.y() || z >= counts_.z()) continue;
      if (gap(1, dy) * gap(1, dy) + gap(2, dz) * gap(2, dz) > reach2) continue;
      const int end = begin_[cube({last, y, z}) + 1];
      for (int i = begin_[cube({first, y, z})]; i < end; ++i) visit(sorted_[i]);
    }
}

std::optional<Vec3> NearPoints::nearest(const Vec3& at) const {
  float least = reach_ * reach_;
  const Vec3* found = nullptr;
  visit(at, least, [&](const Vec3& point) {
    const float d = (point - at).squaredNorm();
    if (d >= least) return;
    least = d;
    found = &point;
  });
  return found ? std::optional<Vec3>(*found) : std::nullopt;
}

void NearPoints::within(const Vec3& at, float radius, std::vector<Vec3>& found) const {
  found.clear();
  const float most = std::min(radius, reach_) * std::min(radius, reach_);
  visit(at, most, [&](const Vec3& point) {
    if ((point - at).squaredNorm() <= most) found.push_back(point);
  });
}

std::optional<Facing> facing(const std::vector<Vec3>& points) {
  if (points.size() < kFewestFacing) return std::nullopt;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& point : points) mean += point;
  mean /= static_cast<float>(points.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& point : points) scatter += (point - mean) * (point - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(scatter);
  const Vec3 spread = solver.eigenvalues();
  return Facing{solver.eigenvectors().col(0), std::max(0.0f, spread[0]) / std::max(spread[1], 1e-12f)};
}

}  // namespace understudy
