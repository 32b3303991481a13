#include "retarget/geometry/near_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"

namespace understudy {
namespace {

Points cloud(int count) {
  Rng rng(3);
  Points points(count, 3);
  for (int i = 0; i < count; ++i) points.row(i) << rng.uniform(), rng.uniform(), rng.uniform();
  return points;
}

TEST(NearPoints, FindsTheNearestAsALookAtAllPointsDoes) {
  const Points points = cloud(2000);
  const NearPoints near(points, Vec3::Zero(), Vec3::Ones(), 0.08f);
  EXPECT_EQ(near.size(), 2000);
  Rng rng(4);
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 at(rng.uniform(-0.2f, 1.2f), rng.uniform(-0.2f, 1.2f), rng.uniform(-0.2f, 1.2f));
    Eigen::Index nearest = 0;
    const float least = (points.rowwise() - at.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    const auto answer = near.nearest(at);
    ASSERT_EQ(answer.has_value(), std::sqrt(least) < 0.08f) << at.transpose();
    if (!answer) continue;
    EXPECT_EQ(*answer, Vec3(points.row(nearest)));
    ++found;
  }
  EXPECT_GT(found, 100);
}

TEST(NearPoints, FindsAllWithinARadius) {
  const Points points = cloud(2000);
  const NearPoints near(points, Vec3::Zero(), Vec3::Ones(), 0.1f);
  const Vec3 at(0.4f, 0.6f, 0.5f);
  std::vector<Vec3> found;
  near.within(at, 0.09f, found);
  const auto squared = (points.rowwise() - at.transpose()).rowwise().squaredNorm().array();
  EXPECT_EQ(static_cast<Eigen::Index>(found.size()), (squared <= 0.09f * 0.09f).count());
  EXPECT_GT(found.size(), 3u);
}

TEST(NearPoints, LeavesOutWhatIsOutsideTheBoxOrNoNumber) {
  Points points(4, 3);
  points << 0.5f, 0.5f, 0.5f, 3, 3, 3, std::numeric_limits<float>::quiet_NaN(), 0, 0, 1, 1, 1;
  const NearPoints near(points, Vec3::Zero(), Vec3::Ones(), 0.1f);
  EXPECT_EQ(near.size(), 2);
  EXPECT_FALSE(near.nearest({3, 3, 3}));
  EXPECT_FALSE(near.nearest(Vec3::Constant(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_FALSE(near.nearest(Vec3::Constant(1e30f)));
  EXPECT_TRUE(near.nearest({1, 1, 1.05f}));
}

TEST(NearPoints, TakesLargerCubesInAHugeBox) {
  Points points(2, 3);
  points << 0, 0, 0, 9000, 9000, 9000;
  const NearPoints near(points, Vec3::Zero(), Vec3::Constant(9000), 0.1f);
  EXPECT_TRUE(near.nearest({0.05f, 0, 0}));
  EXPECT_FALSE(near.nearest({0.2f, 0, 0}));
  EXPECT_TRUE(near.nearest({9000, 9000, 9000}));
}

TEST(NearPoints, RefusesABoxWithoutNumbers) {
  EXPECT_THROW(
      NearPoints(cloud(9), Vec3::Zero(), Vec3::Constant(std::numeric_limits<float>::infinity()), 0.1f),
      Error);
  EXPECT_THROW(NearPoints(cloud(9), Vec3::Zero(), Vec3::Ones(), 0), Error);
}

TEST(Facing, OfASlabIsAcrossIt) {
  Rng rng(9);
  std::vector<Vec3> slab, ball;
  for (int i = 0; i < 200; ++i) {
    slab.emplace_back(rng.normal(), 0.05f * rng.normal() + 2, rng.normal());
    ball.emplace_back(rng.normal(), rng.normal(), rng.normal());
  }
  const auto face = facing(slab);
  ASSERT_TRUE(face);
  EXPECT_GT(std::abs(face->normal.y()), 0.99f);
  EXPECT_LT(face->thickness, 0.01f);
  EXPECT_GT(facing(ball)->thickness, 0.4f);
  EXPECT_FALSE(facing({slab[0], slab[1], slab[2]}));
}

}  // namespace
}  // namespace understudy
