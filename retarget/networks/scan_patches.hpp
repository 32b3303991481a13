// Input of the extractor: a scan, normalised, sampled to a fixed number of points, cut into overlapping
// patches.
#pragma once

#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy::nn {

constexpr int kScanPoints = 1024;  ///< points the network sees
constexpr int kPatches = 128;      ///< patch centres, far apart
constexpr int kPatchPoints = 24;   ///< nearest points of each centre

struct ScanPatches {
  Vec3 centre = Vec3::Zero();     ///< median of the points, metres
  float scale = 1;                ///< mean distance from it, metres: normalised = (x - centre) / scale
  Points points;                  ///< [kScanPoints, 3] normalised
  std::vector<int> centre_index;  ///< [kPatches] which of the input points the centres are
  Points centres;                 ///< [kPatches, 3] normalised
  Points offsets;                 ///< [kPatches * kPatchPoints, 3] neighbours minus their centre, normalised
};

/// Cuts exactly kScanPoints points, [kScanPoints, 3] metres, into patches. The median and a mean distance are
/// used because outliers and floor move them little. Throws Error when all points coincide.
ScanPatches cut_patches(const Points& points);

/// Which of a scan's points extractors look at: always the same ones, so that the same scan gives the same
/// joints.
constexpr uint64_t kThinningSeed = 20240318;

/// Exactly kScanPoints finite points of a scan: of a mesh's surface, or of a cloud (with repeats when it has
/// fewer). `seed` picks which. Throws Error when fewer than 32 points are finite.
Points thin_scan(const Mesh& scan, uint64_t seed);

}  // namespace understudy::nn
