#include "retarget/networks/scan_patches.hpp"

#include <algorithm>
#include <cstring>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

float median(Eigen::ArrayXf values) {
  float* middle = values.data() + values.size() / 2;
  std::nth_element(values.data(), middle, values.data() + values.size());
  return *middle;
}

constexpr int kGroups = 128;  // of points
static_assert(kScanPoints % kGroups == 0 && kGroups >= kPatchPoints);

using Distances = Eigen::Array<float, kScanPoints, 1>;

/// Distances and numbers in one integer, which sorts as they do: so do the bits of a positive float.
uint64_t key_of(float squared, int point) {
  uint32_t bits;
  std::memcpy(&bits, &squared, 4);
  return static_cast<uint64_t>(bits) << 32 | static_cast<uint32_t>(point);
}

/// The kPatchPoints nearest of all points, as keys. Each group's nearest is found first: where so many groups
/// begin, so many points lie, and only few others can be nearer than the last of those.
void nearest_of(const Distances& squared, std::vector<uint64_t>& keys) {
  Eigen::Array<float, kGroups, 1> nearest = squared.head<kGroups>();  // every kGroups-th point is a group
  for (int i = kGroups; i < kScanPoints; i += kGroups) nearest = nearest.min(squared.segment<kGroups>(i));
  Eigen::Array<float, kGroups, 1> sorted = nearest;
  std::nth_element(sorted.data(), sorted.data() + (kPatchPoints - 1), sorted.data() + kGroups);
  const float enough = sorted[kPatchPoints - 1];
  keys.clear();
  for (int group = 0; group < kGroups; ++group)
    for (int i = group; nearest[group] <= enough && i < kScanPoints; i += kGroups)
      if (squared[i] <= enough) keys.push_back(key_of(squared[i], i));
  std::nth_element(keys.begin(), keys.begin() + (kPatchPoints - 1), keys.end());
}

}  // namespace

ScanPatches cut_patches(const Points& points) {
  US_CHECK(points.rows() == kScanPoints, "patches are cut from ", kScanPoints, " points, not ",
           points.rows());
  ScanPatches patches;
  for (int axis = 0; axis < 3; ++axis) patches.centre[axis] = median(points.col(axis).array());
  Points& x = patches.points;
  x = points.rowwise() - patches.centre.transpose();
  patches.scale = x.rowwise().norm().mean();
  US_CHECK(patches.scale > 1e-6f, "all points of the scan coincide");
  x /= patches.scale;

  // From the point nearest to the middle, so that the choice does not depend on the order of the points.
  Eigen::Index first;
  x.rowwise().squaredNorm().minCoeff(&first);
  patches.centre_index = farthest_points(x, kPatches, first);

  const Distances px = x.col(0), py = x.col(1), pz = x.col(2);
  std::vector<uint64_t> keys;
  keys.reserve(kScanPoints);
  patches.centres.resize(kPatches, 3);
  patches.offsets.resize(kPatches * kPatchPoints, 3);
  for (int m = 0; m < kPatches; ++m) {
    const Vec3 c = x.row(patches.centre_index[m]);
    patches.centres.row(m) = c.transpose();
    nearest_of((px - c[0]).square() + (py - c[1]).square() + (pz - c[2]).square(), keys);
    for (int k = 0; k < kPatchPoints; ++k)
      patches.offsets.row(m * kPatchPoints + k) = x.row(static_cast<uint32_t>(keys[k])) - c.transpose();
  }
  return patches;
}

Points thin_scan(const Mesh& scan, uint64_t seed) {
  Rng rng(seed);
  Mesh finite = scan;
  if (!scan.vertices.allFinite()) finite = Mesh{finite_points(scan.vertices), Faces(0, 3), Points(0, 3)};
  const Eigen::Index count = finite.vertices.rows();
  US_CHECK(count >= 32, "the scan has only ", count, " usable points; at least 32 are needed");
  Points points = sample_points(finite, kScanPoints, rng);
  if (points.rows() == kScanPoints) return points;
  Points filled(kScanPoints, 3);
  for (int i = 0; i < kScanPoints; ++i) filled.row(i) = points.row(i % points.rows());
  return filled;
}

}  // namespace understudy::nn
