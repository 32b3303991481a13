#include "retarget/motion_space/sparse_looks.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr int kEnough = 600, kFilled = 1024, kNearPoints = 4;
constexpr float kSpan = 0.7f;  // of the way to a neighbour

}  // namespace

Points filled_between(const Points& points, int count, uint64_t variant) {
  if (points.rows() >= std::min(count, kEnough) || points.rows() <= kNearPoints) return points;
  Rng rng(99 + variant);
  const IntMatrix near = nearest_neighbours(points, points, kNearPoints + 1);
  Points filled(count, 3);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<Eigen::Index>(i % points.rows());
    const int one = near(at, 1 + rng.below(kNearPoints)), other = near(at, 1 + rng.below(kNearPoints));
    float u = rng.uniform(), v = rng.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    filled.row(i) = points.row(at) + kSpan * u * (points.row(one) - points.row(at)) +
                    kSpan * v * (points.row(other) - points.row(at));
  }
  return filled;
}

std::vector<Extraction> looks(SkeletonExtractor& extractor, const Points& points, int ways) {
  std::vector<Extraction> seen;
  for (int way = 0; way < ways; ++way) {
    Mesh scan;
    scan.vertices = filled_between(points, kFilled, static_cast<uint64_t>(way));
    Extraction one = extractor.extract(scan);
    if (one.joints.allFinite()) seen.push_back(std::move(one));
  }
  return seen;
}

}  // namespace understudy
