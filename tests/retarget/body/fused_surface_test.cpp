#include "retarget/body/fused_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "retarget/body/builtin_person.hpp"
#include "retarget/body/posed_surface.hpp"
#include "retarget/math/directions.hpp"

namespace understudy {
namespace {

constexpr int kBall = 4000;

/// A ball of 1 dm about the origin.
OrientedPoints ball() {
  OrientedPoints cloud;
  cloud.points.resize(kBall, 3);
  for (int i = 0; i < kBall; ++i) cloud.points.row(i) = 0.1f * spread_direction(i, kBall).transpose();
  cloud.normals = 10 * cloud.points;
  cloud.parts.assign(kBall, Head);
  return cloud;
}
constexpr float kBallPoint = 4 * kPi * 0.01f / kBall;  // square metres

/// Two balls, one beside the other, `gap` metres between them.
OrientedPoints two_balls(float gap) {
  OrientedPoints one = ball(), both = one;
  one.points.col(0).array() += 0.2f + gap;
  both.points.conservativeResize(2 * kBall, 3);
  both.points.bottomRows(kBall) = one.points;
  both.normals.conservativeResize(2 * kBall, 3);
  both.normals.bottomRows(kBall) = one.normals;
  both.parts.resize(2 * kBall, Neck);
  return both;
}

const ShapedBody& standing() {
  static const ShapedBody body = builtin_person();
  return body;
}

struct Person {
  const ShapedBody& body = standing();
  SurfaceSampler sampler{body.vertices, body.faces};
  Pose pose;
  PosedSurface surface{body, pose, {}};

  OrientedPoints cloud(int count, uint64_t seed = 1) {
    Rng rng(seed);
    return surface.sample(sampler, body.faces, count, rng);
  }
};

TEST(SoftSolid, IsOneInsideAHalfOnTheSurfaceAndNothingOutside) {
  const OrientedPoints cloud = ball();
  const SoftSolid solid(cloud.points, cloud.normals, kBallPoint, 0.01f);
  EXPECT_NEAR(solid.at(Vec3::Zero()).inside, 0.985f, 0.02f);
  EXPECT_NEAR(solid.at(Vec3(0, 0.1f, 0)).inside, 0.48f, 0.04f);
  EXPECT_NEAR(solid.at(Vec3(0, 0.2f, 0)).inside, 0.0f, 0.01f);
}

TEST(SoftSolid, SlopeIsTheDerivative) {
  const OrientedPoints cloud = two_balls(0.01f);
  const SoftSolid solid(cloud.points, cloud.normals, kBallPoint, 0.015f);
  for (const Vec3& x : {Vec3(0.09f, 0.03f, 0.01f), Vec3(0.11f, 0.05f, 0), Vec3(0, -0.12f, 0.02f)})
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = 1e-3f * Vec3::Unit(axis);
      const float numeric = (solid.at(x + step).inside - solid.at(x - step).inside) / 2e-3f;
      EXPECT_NEAR(solid.at(x).slope[axis], numeric, 0.03f * solid.at(x).slope.norm() + 0.2f);
    }
}

TEST(SoftSolid, LevelsBelowAHalfAreThickerAndThoseAboveThinner) {
  const OrientedPoints cloud = ball();
  const SoftSolid solid(cloud.points, cloud.normals, kBallPoint, 0.01f);
  const Vec3 x(0.1f, 0, 0);
  const auto thick = solid.level_point(x, 0.3f, 0.05f), thin = solid.level_point(x, 0.7f, 0.05f);
  ASSERT_TRUE(thick && thin);
  EXPECT_GT(thick->x(), 0.102f);
  EXPECT_LT(thin->x(), 0.098f);
  EXPECT_LT(thick->x() - thin->x(), 0.03f);
  EXPECT_FALSE(solid.level_point(x, 1.5f, 0.05f));  // nowhere
}

TEST(Weld, ClosesWhatNearlyTouchesAndLeavesTheRest) {
  const OrientedPoints before = two_balls(0.004f);
  OrientedPoints cloud = before;
  const SoftSolid solid(cloud.points, cloud.normals, kBallPoint, 0.02f);
  weld(cloud, solid, 0.62f);
  ASSERT_EQ(cloud.points.rows(), cloud.normals.rows());
  ASSERT_EQ(cloud.points.rows(), static_cast<Eigen::Index>(cloud.parts.size()));
  const auto near_axis = [](const OrientedPoints& of, float radius) {  // between the balls
    int count = 0;
    for (Eigen::Index i = 0; i < of.points.rows(); ++i)
      count += std::abs(of.points(i, 0) - 0.102f) < 0.012f && of.points.row(i).tail<2>().norm() < radius;
    return count;
  };
  EXPECT_GT(near_axis(before, 0.012f), 20);
  EXPECT_EQ(near_axis(cloud, 0.012f), 0);
  EXPECT_GT(cloud.points.rows(), 19 * before.points.rows() / 20);
  const auto far = [](const OrientedPoints& of) {
    int count = 0;
    for (Eigen::Index i = 0; i < of.points.rows(); ++i) count += of.points(i, 0) < 0.03f;
    return count;
  };
  EXPECT_EQ(far(cloud), far(before));
  EXPECT_EQ(cloud.points.row(0), before.points.row(0));
}

TEST(FuseHand, ChangesThatHandOnlyAndClosesItsFingers) {
  Person person;
  const OrientedPoints before = person.cloud(20000);
  const auto solid = person.surface.hand_solid(0, 1100, 0.014f, 3);
  ASSERT_TRUE(solid);
  OrientedPoints cloud = before;
  fuse_hand(cloud, person.surface.truth(), 0, *solid, 0.3f);
  const auto of_part = [](const OrientedPoints& of, int part) {
    std::vector<int> rows;
    for (size_t i = 0; i < of.parts.size(); ++i)
      if (of.parts[i] == part) rows.push_back(static_cast<int>(i));
    return rows;
  };
  const std::vector<int> hand = of_part(cloud, LeftWrist), flat = of_part(before, LeftWrist);
  EXPECT_EQ(cloud.points(of_part(cloud, RightWrist), Eigen::all),
            before.points(of_part(before, RightWrist), Eigen::all));
  EXPECT_EQ(cloud.points(of_part(cloud, LeftElbow), Eigen::all),
            before.points(of_part(before, LeftElbow), Eigen::all));
  EXPECT_GT(hand.size(), flat.size() / 2);
  // It stays a hand: where it was, within a few centimetres.
  EXPECT_LT(
      (cloud.points(hand, Eigen::all).colwise().mean() - before.points(flat, Eigen::all).colwise().mean())
          .norm(),
      0.02f);
  const IntMatrix nearest = nearest_neighbours(before.points, cloud.points, 1);
  float moved = 0;
  for (const int i : hand)
    moved = std::max(moved, (cloud.points.row(i) - before.points.row(nearest(i, 0))).norm());
  EXPECT_GT(moved, 0.003f);
  EXPECT_LT(moved, 0.05f);
}

TEST(Voxels, AGridIsFixedInTheWorldAndTheSameForASeed) {
  Person person;
  OrientedPoints a = person.cloud(3000, 1), b = person.cloud(3000, 2);
  b.points.row(7) = a.points.row(7);  // one place that both clouds have
  b.normals.row(7) = a.normals.row(7);
  const Points before = a.points;
  Rng rng(6), same(6);
  snap_to_voxels(a, rng);
  snap_to_voxels(b, same);
  EXPECT_EQ(a.points.row(7), b.points.row(7));
  const float most = (a.points - before).rowwise().norm().maxCoeff();
  EXPECT_GT(most, 0.002f);
  EXPECT_LT(most, 0.025f);
}

TEST(UnevenSurface, MovesAlongNormalsByCentimetresAtMostAndTheSameForASeed) {
  Person person;
  const OrientedPoints cloud = person.cloud(3000);
  const RowMatrix weights = [&] {
    RowMatrix own = RowMatrix::Zero(cloud.points.rows(), kJointCount);
    for (size_t i = 0; i < cloud.parts.size(); ++i) own(static_cast<Eigen::Index>(i), cloud.parts[i]) = 1;
    return own;
  }();
  int changed = 0;
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed), same(seed);
    Points a = cloud.points, b = cloud.points;
    UnevenSurface(person.body.vertices, person.body.joints, rng).apply(a, cloud.normals, weights);
    UnevenSurface(person.body.vertices, person.body.joints, same).apply(b, cloud.normals, weights);
    EXPECT_EQ(a, b);
    const Points moved = a - cloud.points;
    for (Eigen::Index i = 0; i < moved.rows(); ++i) {
      EXPECT_LT(moved.row(i).norm(), 0.15f);
      EXPECT_LT(moved.row(i).cross(cloud.normals.row(i)).norm(), 1e-5f);
      changed += moved.row(i).norm() > 0.003f;
    }
  }
  EXPECT_GT(changed, 2000);
}

}  // namespace
}  // namespace understudy
