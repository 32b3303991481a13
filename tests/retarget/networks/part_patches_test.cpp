#include "retarget/networks/part_patches.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

TEST(PartPatches, HoldTheNearestPointsOfCentresThatLieApart) {
  const Points points = Points::Random(200, 3);
  const Points patches = cut_part_patches(points);
  ASSERT_EQ(patches.rows(), kPartPatchRows);
  for (int m = 0; m < kPartPatches; ++m) {
    const Eigen::RowVector3f centre = patches.row(m);
    const auto distances = (points.rowwise() - centre).rowwise().norm().eval();
    EXPECT_EQ(distances.minCoeff(), 0) << "a centre is a point";
    const auto near = patches.middleRows(kPartPatches + m * kPartPatchPoints, kPartPatchPoints);
    const float farthest = near.rowwise().norm().maxCoeff();
    EXPECT_EQ((distances.array() < farthest - 1e-6f).count(), kPartPatchPoints - 1);
    for (int other = 0; other < m; ++other) EXPECT_GT((patches.row(other) - centre).norm(), 0.1f);
  }
}

TEST(PartPatches, RepeatWherePointsAreFew) {
  const Points points = Points::Random(kPartPatchPoints, 3);
  const Points patches = cut_part_patches(points);
  ASSERT_TRUE(patches.allFinite());
  EXPECT_EQ(patches.row(0), patches.row(kPartPatchPoints));
  EXPECT_THROW(cut_part_patches(points.topRows(kPartPatchPoints - 1)), Error);
}

}  // namespace
}  // namespace understudy::nn
