#include "retarget/networks/part_patches.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy::nn {
namespace {

std::vector<int> centres_of(const Points& points) {
  Eigen::Index first;
  (points.rowwise() - points.colwise().mean()).rowwise().squaredNorm().minCoeff(&first);
  const int count = static_cast<int>(std::min<Eigen::Index>(kPartPatches, points.rows()));
  std::vector<int> chosen = farthest_points(points, count, static_cast<int>(first));
  for (int i = count; i < kPartPatches; ++i) chosen.push_back(chosen[i - count]);
  return chosen;
}

}  // namespace

Points cut_part_patches(const Points& points) {
  US_CHECK(points.rows() >= kPartPatchPoints, "patches are cut from ", kPartPatchPoints,
           " points or more, not ", points.rows());
  Points patches(kPartPatchRows, 3);
  const std::vector<int> centres = centres_of(points);
  const Eigen::ArrayXf x = points.col(0), y = points.col(1), z = points.col(2);
  std::vector<std::pair<float, int>> nearest(points.rows());
  for (int m = 0; m < kPartPatches; ++m) {
    const Vec3 c = points.row(centres[m]);
    const Eigen::ArrayXf squared = (x - c.x()).square() + (y - c.y()).square() + (z - c.z()).square();
    for (int i = 0; i < ssize(nearest); ++i) nearest[i] = {squared[i], i};
    std::nth_element(nearest.begin(), nearest.begin() + (kPartPatchPoints - 1), nearest.end());
    patches.row(m) = c.transpose();
    for (int k = 0; k < kPartPatchPoints; ++k)
      patches.row(kPartPatches + m * kPartPatchPoints + k) = points.row(nearest[k].second) - c.transpose();
  }
  return patches;
}

}  // namespace understudy::nn
