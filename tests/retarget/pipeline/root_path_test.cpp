#include "retarget/pipeline/root_path.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

struct SideSteps {
  Joints rest_b = 0.6f * human_rest();
  PointBody a{human_rest()}, b{rest_b};
  /// The target's pelvis after each of 60 frames of a source that steps sideways, standing.
  std::vector<Vec3> path(RootMode mode, float height = 1.1153f) const {
    RootPathOptions options;
    options.mode = mode;
    RootPath root(options);
    root.reset(b.mesh.vertices, rest_b);
    std::vector<Vec3> result;
    for (int i = 0; i < 60; ++i) {
      const Pose pose{identity_rotations(), Vec3(1 + 0.02f * static_cast<float>(i), height, 2)};
      const Mesh scan = scan_of(a, human_rest(), pose);
      Extraction source;
      source.joints = forward_kinematics(human_rest(), pose).joints;
      source.sole_height =
          sole_height(source.joints, scan.vertices.topRows(scan.vertices.rows() - kJointCount));
      result.push_back(root.push(source, identity_rotations(), 1 / 30.0f));
    }
    return result;
  }
};

TEST(RootPath, StartsWhereTheSourceStarts) {
  const Vec3 first = SideSteps().path(RootMode::Scaled).front();
  EXPECT_FLOAT_EQ(first.x(), 1);
  EXPECT_FLOAT_EQ(first.z(), 2);
}

TEST(RootPath, ScalesThePathByTheLegs) {
  const auto path = SideSteps().path(RootMode::Scaled);
  EXPECT_NEAR(path.back().x() - path.front().x(), 0.6f * 59 * 0.02f, 1e-3f);
}

TEST(RootPath, KeepsTheOriginalPathWhenAsked) {
  const auto path = SideSteps().path(RootMode::Original);
  EXPECT_NEAR(path.back().x() - path.front().x(), 59 * 0.02f, 1e-3f);
}

TEST(RootPath, StaysInPlaceWhenAsked) {
  const auto path = SideSteps().path(RootMode::InPlace);
  EXPECT_FLOAT_EQ(path.back().x(), path.front().x());
}

TEST(RootPath, PutsTheSolesOnTheFloorWhereTheSourcesAre) {
  const SideSteps walk;  // the source's soles are 1.1153 below its pelvis, the target's at 0.6 of the ankles'
                         // height and 0.1
  const float sole_b = -walk.b.mesh.vertices.col(1).minCoeff();
  for (const Vec3& root : walk.path(RootMode::Scaled)) EXPECT_NEAR(root.y(), sole_b, 0.006f);
}

TEST(RootPath, LiftsTheTargetAsTheSourceIsInTheAir) {
  const SideSteps walk;
  const float sole_b = -walk.b.mesh.vertices.col(1).minCoeff();
  const float up = walk.path(RootMode::Scaled, 1.1153f + 0.3f).back().y();
  EXPECT_NEAR(up, sole_b + 0.6f * 0.3f, 0.01f);
}

/// Points as dense on feet that hang `height` over y = 0 as scanners give them, and a few of the floor below.
Points feet_over_a_floor(const Joints& source, float height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  Points points(700, 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 ankle = source.row(i % 2 == 0 ? LeftAnkle : RightAnkle).transpose();
    const bool sole = i < 300;  // the rest is shin
    points.row(i) =
        Vec3(ankle.x() + 0.04f * unit(random), height + (sole ? 0.0f : 0.1f + 0.08f * unit(random)),
             ankle.z() + (sole ? 0.12f : 0.04f) * unit(random))
            .transpose();
    if (i % 70 == 0) points.row(i) = Vec3(0.3f * unit(random), 0, 0.3f * unit(random)).transpose();
  }
  return points;
}

TEST(SoleHeight, IsThatOfTheFeetNotOfBitsOfFloorBelowThem) {
  Joints source = human_rest();
  for (const float height : {0.0f, 0.06f, 0.15f}) {
    source.col(1).array() += height + 0.08f - source(LeftAnkle, 1);
    const auto sole = sole_height(source, feet_over_a_floor(source, height));
    ASSERT_TRUE(sole);
    EXPECT_NEAR(*sole, height, 0.005f);
  }
}

TEST(SoleHeight, IsUnknownWhereNoFootWasSeen) {
  EXPECT_FALSE(sole_height(human_rest(), Points::Constant(500, 3, 5.0f)));
}

TEST(RootPath, DoesNotJumpWhenTheLegsTurnOutShorter) {
  const SideSteps walk;
  RootPath root;
  root.reset(walk.b.mesh.vertices, walk.rest_b);
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 90; ++i) {
    const float size = i < 3 ? 1.2f : 1.0f;  // the first frames see too long legs
    Extraction source;
    source.joints = size * human_rest();
    source.joints.rowwise() += Eigen::RowVector3f(0.02f * static_cast<float>(i), 1.1f, 0);
    const Vec3 now = root.push(source, identity_rotations(), 1 / 30.0f);
    if (i > 0) EXPECT_LT((now - last).norm(), 0.05f) << i;
    last = now;
  }
  EXPECT_NEAR(root.scale(), 0.6f, 0.02f);
}

}  // namespace
}  // namespace understudy
