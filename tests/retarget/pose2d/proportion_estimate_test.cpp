#include "retarget/pose2d/proportion_estimate.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

PoseLengths told(float length, float doubt) {
  return {BoneLengths::Constant(std::log(length)), BoneLengths::Constant(doubt)};
}

TEST(ProportionEstimate, WhatIsSureCountsMost) {
  ProportionEstimate estimate;
  FlatPose nothing;
  estimate.push(nothing, told(100, 0.05f));
  estimate.push(nothing, told(200, 0.5f));
  const Proportions lengths = estimate.lengths();
  EXPECT_NEAR(lengths.length[flat_bone::Trunk], 100 * std::pow(2.0f, 1 / 101.0f), 0.1f);
  EXPECT_EQ(lengths.poses, 2);
  EXPECT_LT(lengths.doubt[flat_bone::Trunk], 0.06f);
}

TEST(ProportionEstimate, NoBoneIsShorterThanItWasSeenAndSidesAreAlike) {
  ProportionEstimate estimate;
  FlatPose person = flat_person();
  person.set(body25::LeftWrist, person.at(body25::LeftElbow) + Vec2(90, 0), 1);
  for (int i = 0; i < 10; ++i) estimate.push(person, told(50, 0.1f));
  const Proportions lengths = estimate.lengths();
  EXPECT_GT(lengths.length[flat_bone::LeftForearm], 0.9f * 90);
  EXPECT_EQ(lengths.length[flat_bone::LeftForearm], lengths.length[flat_bone::RightForearm]);
}

TEST(ProportionEstimate, OneWrongFrameInAHundredDoesNotMakeALimbLong) {
  ProportionEstimate estimate;
  for (int i = 0; i < 200; ++i) {
    FlatPose person = flat_person();
    if (i == 77) person.set(body25::LeftWrist, Vec2(2000, 0), 0.3f);
    estimate.push(person, told(50, 0.1f));
  }
  EXPECT_LT(estimate.lengths().length[flat_bone::LeftForearm], 60);
}

TEST(ProportionEstimate, NobodySeenIsAnError) {
  EXPECT_THROW(ProportionEstimate().lengths(), Error);
}

}  // namespace
}  // namespace understudy
