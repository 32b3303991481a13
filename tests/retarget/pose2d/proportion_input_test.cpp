#include "retarget/pose2d/proportion_input.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

FlatPose some_points() {
  FlatPose pose;
  for (int p = 0; p < kBodyPoints; ++p)
    pose.set(p, Vec2(100 + 7.0f * static_cast<float>(p * p % 11), 50 + 9.0f * static_cast<float>(p * 5 % 13)),
             0.5f + 0.02f * static_cast<float>(p));
  return pose;
}

TEST(ProportionInput, HangsNeitherOnPlaceNorOnSize) {
  const FlatPose pose = some_points();
  FlatPose other = pose;
  for (int p = 0; p < kBodyPoints; ++p) other.set(p, 3 * pose.at(p) + Vec2(-700, 40), pose.confidence(p));
  const ProportionInput a = proportion_input(pose), b = proportion_input(other);
  EXPECT_LT((a.numbers - b.numbers).cwiseAbs().maxCoeff(), 1e-4f);
  EXPECT_NEAR(b.size, 3 * a.size, 1e-2f);
}

TEST(ProportionInput, WhatIsMissingIsZeroAndMiddlesAreMade) {
  FlatPose pose = some_points();
  pose.forget(body25::LeftElbow);
  pose.forget(body25::Neck);
  const ProportionInput input = proportion_input(pose);
  EXPECT_EQ(input.numbers.segment<4>(4 * body25::LeftElbow).norm(), 0);
  EXPECT_EQ(input.numbers.segment<2>(4 * kPaperPoints + 2 * flat_bone::LeftForearm).norm(), 0);
  EXPECT_EQ(input.numbers[4 * body25::Neck + 2], 1);  // from the shoulders
}

TEST(ProportionInput, FeetDoNotCount) {
  FlatPose pose = some_points();
  const ProportionInput before = proportion_input(pose);
  pose.set(body25::LeftHeel, Vec2(5000, 5000), 1);
  EXPECT_EQ(proportion_input(pose).numbers, before.numbers);
}

TEST(ProportionInput, AMirroredPoseIsMirroredNumbers) {
  const ProportionInput a = proportion_input(some_points()), b = proportion_input(in_mirror(some_points()));
  for (int p = 0; p < kPaperPoints; ++p) {
    const int other = kBodyMirror[static_cast<size_t>(p)];
    EXPECT_NEAR(a.numbers[4 * p], -b.numbers[4 * other], 1e-5f);
    EXPECT_NEAR(a.numbers[4 * p + 1], b.numbers[4 * other + 1], 1e-5f);
  }
}

TEST(ProportionInput, RefusesNobodyOnePointOnePlaceAndNoNumbers) {
  EXPECT_THROW(proportion_input({}), Error);
  FlatPose one;
  one.set(body25::Nose, Vec2(3, 4), 1);
  one.set(body25::LeftHeel, Vec2(30, 40), 1);  // none of the 15
  EXPECT_THROW(proportion_input(one), Error);
  one.set(body25::LeftHip, Vec2(3, 4), 1);
  EXPECT_THROW(proportion_input(one), Error);
  FlatPose broken = some_points();
  broken.body(body25::LeftKnee, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(proportion_input(broken), Error);
  broken = some_points();
  broken.body(body25::LeftKnee, 0) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(proportion_input(broken), Error);
}

}  // namespace
}  // namespace understudy
