#include "retarget/geometry/cloud_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "retarget/base/rng.hpp"

namespace understudy {
namespace {

Points ball(int count) {
  Rng rng(5);
  Points points(count, 3);
  for (int i = 0; i < count; ++i) points.row(i) = Vec3(rng.normal(), rng.normal(), rng.normal()).normalized();
  return points;
}

TEST(EstimatedNormals, OfABallPointOutOrIn) {
  const Points points = ball(3000), normals = estimated_normals(points);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    EXPECT_GT(std::abs(points.row(i).dot(normals.row(i))), 0.97f) << i;
}

TEST(PointedOutwards, NormalsOfABallWithAHolePointOut) {
  Points points = ball(3000);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 2) < 0.9f) kept.push_back(i);
  points = Points(points(kept, Eigen::all));
  const Points normals = pointed_outwards(points, estimated_normals(points));
  Eigen::Index wrong = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) wrong += points.row(i).dot(normals.row(i)) < 0;
  EXPECT_EQ(wrong, 0);
}

TEST(EstimatedNormals, OfTooFewOrBadPointsAreZero) {
  EXPECT_TRUE(estimated_normals(ball(3)).isZero());
  Points bad = ball(50);
  bad(7, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(estimated_normals(bad).isZero());
}

TEST(PointSpacing, OfABallIsTheRootOfItsAreaAPoint) {
  EXPECT_NEAR(point_spacing(ball(4000)), std::sqrt(4 * kPi / 4000), 0.012f);
  EXPECT_EQ(point_spacing(ball(5)), 0);
}

TEST(PointSpacing, OfBadPointsAloneIsZero) {
  EXPECT_EQ(point_spacing(Points::Constant(20, 3, std::numeric_limits<float>::quiet_NaN())), 0);
}

}  // namespace
}  // namespace understudy
