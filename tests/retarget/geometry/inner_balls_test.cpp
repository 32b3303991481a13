#include "retarget/geometry/inner_balls.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/rng.hpp"
#include "retarget/math/types.hpp"

namespace understudy {
namespace {

struct Skin {
  Points points, normals;
};

/// Points of an ellipsoid with these half axes.
Skin ellipsoid(const Vec3& half, int count) {
  Rng rng(3);
  Skin skin{Points(count, 3), Points(count, 3)};
  for (int i = 0; i < count; ++i) {
    const float up = rng.uniform(-1, 1), angle = rng.uniform(0, 2 * kPi), across = std::sqrt(1 - up * up);
    const Vec3 on_ball(across * std::cos(angle), up, across * std::sin(angle));
    skin.points.row(i) = on_ball.cwiseProduct(half).transpose();
    skin.normals.row(i) = on_ball.cwiseQuotient(half).normalized().transpose();
  }
  return skin;
}

TEST(InnerBalls, OfABallAreTheBall) {
  const Skin ball = ellipsoid({0.3f, 0.3f, 0.3f}, 1500);
  const Eigen::VectorXf radii = inner_radii(PointTree(ball.points), ball.normals);
  EXPECT_NEAR(radii.mean(), 0.3f, 0.02f);
  EXPECT_GT(radii.minCoeff(), 0.24f);
}

TEST(InnerBalls, OfADiscAreItsHalfThickness) {
  const Skin disc = ellipsoid({0.5f, 0.05f, 0.5f}, 6000);
  const Eigen::VectorXf radii = inner_radii(PointTree(disc.points), disc.normals);
  for (Eigen::Index i = 0; i < radii.size(); ++i) {
    const float from_middle = std::hypot(disc.points(i, 0), disc.points(i, 2));
    if (from_middle < 0.2f) EXPECT_NEAR(radii[i], 0.05f, 0.012f) << from_middle;
    EXPECT_LT(radii[i], 0.065f);
  }
}

}  // namespace
}  // namespace understudy
