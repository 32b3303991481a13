#include "retarget/pipeline/root_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
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
      source.sole_height = sole_height(source, scan.vertices.topRows(scan.vertices.rows() - kJointCount));
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
    const auto sole = sole_height(seen(source), feet_over_a_floor(source, height));
    ASSERT_TRUE(sole);
    EXPECT_NEAR(*sole, height, 0.005f);
  }
}

TEST(SoleHeight, IsUnknownWhereNoFootWasSeen) {
  EXPECT_FALSE(sole_height(seen(human_rest()), Points::Constant(500, 3, 5.0f)));
}

TEST(SupportPoints, KnowTheEdgesOfTheSoles) {
  const ShapedBody body = builtin_person();
  const SupportPoints support = SupportPoints::from(body.vertices, body.joints);
  for (const float roll_deg : {-20.0f, -8.0f, 0.0f, 8.0f, 20.0f}) {
    Pose pose;
    pose.local[Pelvis] = rotation_from_axis_angle(Vec3(0, 0, roll_deg * kPi / 180));
    const Points posed = (body.vertices.rowwise() - body.joints.row(Pelvis)) * pose.local[Pelvis].transpose();
    EXPECT_NEAR(support.lowest(forward_kinematics(body.joints, pose)), posed.col(1).minCoeff(), 0.003f)
        << roll_deg;
  }
}

/// Errors of the legs shake the soles by 3 cm once a second; the median and the largest gap between them and
/// the source's, which stand still.
std::array<float, 2> sole_gaps(float contact, bool bends_legs) {
  const SideSteps stand;
  RootPathOptions options;
  options.contact = contact;
  RootPath root(options);
  root.reset(stand.b.mesh.vertices, stand.rest_b);
  const SupportPoints support = SupportPoints::from(stand.b.mesh.vertices, stand.rest_b);
  std::vector<float> gaps;
  for (int i = 0; i < 90; ++i) {
    Extraction source;
    source.joints = human_rest();
    source.joints.rowwise() += Eigen::RowVector3f(0, 1.1f, 0);
    source.sole_height = 0.01f;
    Pose pose;
    const float bend = 0.25f * (1 + std::sin(2 * kPi * static_cast<float>(i) / 30));
    for (const int side : {0, 1}) {
      pose.local[LeftHip + side] = rotation_from_axis_angle(Vec3(-bend, 0, 0));
      pose.local[LeftKnee + side] = rotation_from_axis_angle(Vec3(2 * bend, 0, 0));
      pose.local[LeftAnkle + side] = rotation_from_axis_angle(Vec3(-bend, 0, 0));
    }
    pose.root = root.push(source, pose.local, 1 / 30.0f);
    if (bends_legs) pose = root.plant(pose, 1 / 30.0f);
    const PosedSkeleton posed = forward_kinematics(stand.rest_b, pose);
    gaps.push_back(std::abs(support.lowest(posed) + posed.joints(Pelvis, 1) - 0.6f * 0.01f));
  }
  std::sort(gaps.begin(), gaps.end());
  return {gaps[gaps.size() / 2], gaps.back()};
}

TEST(RootPath, KeepsTheSolesAtTheSourcesHeightWithLegsThatAreBentForIt) {
  const auto [median, worst] = sole_gaps(0.5f, true);
  EXPECT_LT(median, 0.003f);
  EXPECT_LT(worst, 0.013f);
}

TEST(RootPath, KeepsTheSolesNearerTheSourcesHeightWhereThePelvisAloneTakesThemThere) {
  const float half = sole_gaps(0.5f, false)[0], whole = sole_gaps(1, false)[0];
  EXPECT_LT(whole, 0.75f * half);
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
