#include "retarget/networks/scan_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

Points blob(int count, uint64_t seed) {
  Rng rng(seed);
  Points points(count, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = rng.normal();
  return points;
}

std::set<std::array<float, 3>> as_set(const Points& points) {
  std::set<std::array<float, 3>> rows;
  for (Eigen::Index i = 0; i < points.rows(); ++i) rows.insert({points(i, 0), points(i, 1), points(i, 2)});
  return rows;
}

TEST(ScanPatches, DoNotDependOnTheOrderOfThePoints) {
  const Points points = blob(kScanPoints, 1);
  Points turned = points.colwise().reverse();
  EXPECT_EQ(as_set(cut_patches(points).centres), as_set(cut_patches(turned).centres));
}

TEST(ScanPatches, AreTheSameForAMovedAndScaledScan) {
  const Points points = blob(kScanPoints, 2);
  const Points moved = (4.0f * points).rowwise() + Eigen::RowVector3f(8, -16, 2);
  const ScanPatches a = cut_patches(points), b = cut_patches(moved);
  EXPECT_LT((a.centres - b.centres).cwiseAbs().maxCoeff(), 1e-4f);
  EXPECT_NEAR(b.scale, 4 * a.scale, 1e-4f);
}

TEST(ScanPatches, HoldTheNearestPointsOfTheirCentre) {
  const ScanPatches patches = cut_patches(blob(kScanPoints, 3));
  for (int m = 0; m < kPatches; ++m) {
    const Eigen::ArrayXf all = (patches.points.rowwise() - patches.centres.row(m)).rowwise().norm();
    const float farthest =
        patches.offsets.middleRows(m * kPatchPoints, kPatchPoints).rowwise().norm().maxCoeff();
    EXPECT_LE((all < farthest - 1e-5f).count(), kPatchPoints);
  }
}

TEST(ScanPatches, RefuseCoincidingPoints) {
  EXPECT_THROW(cut_patches(Points::Ones(kScanPoints, 3)), Error);
}

TEST(ThinScan, LeavesOutPointsThatAreNotNumbers) {
  Mesh scan{blob(2000, 4), Faces(0, 3), Points(0, 3)};
  scan.vertices(7, 1) = std::numeric_limits<float>::quiet_NaN();
  scan.vertices(9, 0) = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(thin_scan(scan, 1).allFinite());
}

TEST(ThinScan, FillsUpASmallScan) {
  EXPECT_EQ(thin_scan(Mesh{blob(40, 5), Faces(0, 3), Points(0, 3)}, 1).rows(), kScanPoints);
}

TEST(ThinScan, RefusesThreePoints) {
  EXPECT_THROW(thin_scan(Mesh{blob(3, 6), Faces(0, 3), Points(0, 3)}, 1), Error);
}

}  // namespace
}  // namespace understudy::nn
