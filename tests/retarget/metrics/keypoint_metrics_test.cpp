#include "retarget/metrics/keypoint_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

TEST(KeypointSimilarity, IsHundredForTheSamePoseWhereverItIs) {
  EXPECT_NEAR(keypoint_similarity(flat_person(700), flat_person(300)), 100, 1e-3);
  EXPECT_NEAR(normalised_point_error(flat_person(700), flat_person(300)), 0, 1e-3);
}

TEST(KeypointSimilarity, OfOnePointIsTheFormula) {
  const FlatPose truth = flat_person();
  FlatPose pose = truth;
  pose.set(body25::Nose, truth.at(body25::Nose) + Vec2(5, 0), 1);  // inside the box: centres stay
  const double area = 0.53 * (2 * 46) * (310 - 10), k = 2 * 0.026;
  EXPECT_NEAR(keypoint_similarity(pose, truth), 100 * (14 + std::exp(-25 / (2 * area * k * k))) / 15, 0.01);
  EXPECT_NEAR(normalised_point_error(pose, truth), 100 * 5 / std::hypot(92.0, 300.0) / 15, 0.01);
}

TEST(KeypointSimilarity, MissingPointsDoNotCount) {
  FlatPose pose = flat_person();
  pose.forget(body25::Nose);
  EXPECT_NEAR(keypoint_similarity(pose, flat_person()), 100, 1e-3);
  EXPECT_TRUE(std::isnan(keypoint_similarity(FlatPose(), flat_person())));
}

TEST(OrderViolation, CountsPairsThatChangedSides) {
  const FlatPose source = flat_person();
  EXPECT_EQ(order_violation(source, source), 0);
  FlatPose mirrored = source;
  for (int p = 0; p < kBodyPoints; ++p) mirrored.set(p, Vec2(600 - source.at(p).x(), source.at(p).y()), 1);
  EXPECT_GT(order_violation(mirrored, source), 20);
}

TEST(BoneAngleError, OfOneTurnedForearmIsTheFormula) {
  const FlatPose source = flat_person();
  FlatPose pose = source;
  const Vec2 way = source.at(body25::RightWrist) - source.at(body25::RightElbow);
  pose.set(body25::RightWrist, source.at(body25::RightElbow) + Vec2(-way.y(), way.x()), 1);
  EXPECT_NEAR(bone_angle_error(pose, source), std::sqrt(1.5708 * 1.5708 / 14), 1e-3);
}

TEST(BoneRatioError, LooksAtSharesAlone) {
  const BoneLengths truth = seen_lengths(flat_person());
  EXPECT_NEAR(bone_ratio_error(3 * truth, truth), 0, 1e-3);
  BoneLengths off = truth;
  off[flat_bone::Head] *= 2;
  EXPECT_GT(bone_ratio_error(off, truth), 5);
}

TEST(TouchesKept, CountsTheSourcesAlone) {
  FlatPose source = flat_person(), pose = source;
  const double stature = 340;
  source.set(body25::RightWrist, source.at(body25::RightKnee) + Vec2(3, 0), 1);
  pose.set(body25::RightWrist, pose.at(body25::RightKnee) + Vec2(40, 0), 1);
  const Touches lost = touches_kept(pose, stature, source, stature),
                kept = touches_kept(source, stature, source, stature);
  EXPECT_EQ(lost.near, kept.near);
  EXPECT_EQ(kept.kept, kept.near);
  EXPECT_EQ(lost.kept, lost.near - 1);
}

}  // namespace
}  // namespace understudy
