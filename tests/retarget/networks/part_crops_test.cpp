#include "retarget/networks/part_crops.hpp"

#include <gtest/gtest.h>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy::nn {
namespace {

constexpr const Part& kLeftHand = kCroppedParts[4];
constexpr const Part& kRightHand = kCroppedParts[5];

/// A dancer with a cloud about every joint.
struct Scene {
  Points points;
  Extraction seen;
};

Scene scene(float t) {
  const PosedSkeleton posed = forward_kinematics(human_rest(), fixtures::dance(t));
  Scene made;
  made.seen.joints = posed.joints;
  made.seen.global = posed.global;
  Rng rng(5);
  made.points.resize(kJointCount * 60, 3);
  for (Eigen::Index i = 0; i < made.points.rows(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      made.points(i, axis) = posed.joints(i / 60, axis) + 0.04f * rng.normal();
  return made;
}

TEST(PartCrops, HoldThePointsNearTheJointInItsFrame) {
  const Scene s = scene(1);
  const auto crop = cut_part(s.points, s.seen, kLeftHand);
  ASSERT_TRUE(crop);
  EXPECT_EQ(crop->points.rows(), kPartPatchRows);
  EXPECT_LT(crop->points.topRows(kPartPatches).rowwise().norm().maxCoeff(), 0.18f + 0.085f + 1e-4f);
  // The elbow lies at the other side of a left wrist than +x.
  EXPECT_LT(crop->context[0], -0.1f);
}

TEST(PartCrops, OfLegsHoldPoints) {
  const Scene s = scene(1);
  const auto crop = cut_part(s.points, s.seen, kCroppedParts[0]);
  ASSERT_TRUE(crop);
  EXPECT_EQ(crop->points.rows(), kPartPoints);
  EXPECT_LT(crop->points.rowwise().norm().maxCoeff(), 0.30f + 1e-4f);
}

TEST(PartCrops, StayTheSameWhenTheWorldTurnsAndGrows) {
  const Scene s = scene(1);
  const Mat3 R = rotation_from_axis_angle(Vec3(0.4f, -1, 0.2f));
  Scene turned = s;
  turned.points = (2 * s.points * R.transpose()).rowwise() + Vec3(1, 2, 3).transpose();
  turned.seen.joints = (2 * s.seen.joints * R.transpose()).rowwise() + Vec3(1, 2, 3).transpose();
  for (Mat3& G : *turned.seen.global) G = R * G;
  for (const Part& part : kCroppedParts) {
    const auto a = cut_part(s.points, s.seen, part), b = cut_part(turned.points, turned.seen, part);
    ASSERT_TRUE(a && b);
    EXPECT_LT((a->points - b->points).cwiseAbs().maxCoeff(), 1e-4f);
    EXPECT_LT((a->context - b->context).cwiseAbs().maxCoeff(), 1e-4f);
  }
}

TEST(PartCrops, ARightOneInAMirrorIsALeftOne) {
  const Scene s = scene(1);
  Scene mirror = s;
  const Vec3 flip(-1, 1, 1);
  mirror.points.col(0) *= -1;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto m = static_cast<size_t>(kMirror[j]);
    mirror.seen.joints.row(static_cast<Eigen::Index>(j)) =
        s.seen.joints.row(static_cast<Eigen::Index>(m)).cwiseProduct(flip.transpose());
    (*mirror.seen.global)[j] = flip.asDiagonal() * (*s.seen.global)[m] * flip.asDiagonal();
  }
  const auto right = cut_part(s.points, s.seen, kRightHand),
             left = cut_part(mirror.points, mirror.seen, kLeftHand);
  ASSERT_TRUE(right && left);
  EXPECT_LT((right->points - left->points).cwiseAbs().maxCoeff(), 1e-5f);
  EXPECT_LT((right->context - left->context).cwiseAbs().maxCoeff(), 1e-5f);
}

TEST(PartCrops, TurnsGoInAndComeBack) {
  const Scene s = scene(2);
  const Mat3 world = rotation_from_axis_angle(Vec3(0.3f, 0.5f, -1));
  for (const Part& part : kCroppedParts) {
    EXPECT_LT((from_part(into_part(world, s.seen, part), s.seen, part) - world).norm(), 1e-5f);
    const Mat3& own = (*s.seen.global)[static_cast<size_t>(part.joint)];
    EXPECT_LT((into_part(own, s.seen, part) - Mat3::Identity()).norm(), 1e-5f);
  }
}

TEST(PartCrops, WaysGoInAndComeBackAndRightOnesAreMirrored) {
  const Scene s = scene(2);
  const Vec3 world(0.03f, -0.02f, 0.05f);
  for (const Part& part : kCroppedParts)
    EXPECT_LT((vector_from_part(vector_into_part(world, s.seen, part), s.seen, part) - world).norm(), 1e-6f);
  // Along the frame's own x axis: a left one's way is +x, a right one's -x, in leg lengths.
  for (const Part& part : {kLeftHand, kRightHand}) {
    const Vec3 x = (*s.seen.global)[static_cast<size_t>(part.joint)].col(0);
    const Vec3 way = vector_into_part(leg_length(s.seen.joints) * x, s.seen, part);
    EXPECT_LT((way - Vec3(part.mirrored ? -1.0f : 1.0f, 0, 0)).norm(), 1e-5f);
  }
}

TEST(PartCrops, AreNotCutWhereTheScanHasAHole) {
  Scene s = scene(1);
  const Vec3 wrist = s.seen.joints.row(LeftWrist).transpose();
  for (Eigen::Index i = 0; i < s.points.rows(); ++i)
    if ((s.points.row(i).transpose() - wrist).norm() < 0.4f) s.points.row(i).setConstant(std::nanf(""));
  EXPECT_FALSE(cut_part(s.points, s.seen, kLeftHand));
  EXPECT_TRUE(cut_part(s.points, s.seen, kRightHand));
}

}  // namespace
}  // namespace understudy::nn
