#include "retarget/pose2d/growth_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace understudy {
namespace {

constexpr double kFrame = 1.0 / 30;

PoseLengths times_as_large(float times, float doubt = 0.1f) {
  return {BoneLengths::Constant(std::log(100 * times)), BoneLengths::Constant(doubt)};
}
Proportions hundred() {
  Proportions lengths;
  lengths.length.setConstant(100);
  return lengths;
}

TEST(GrowthEstimate, TheFirstPoseTellsAndLaterOnesAreFollowedSlowly) {
  GrowthEstimate growth;
  EXPECT_EQ(growth.growth(), 1);
  EXPECT_NEAR(growth.push(times_as_large(1), hundred(), kFrame), 1, 1e-5);
  EXPECT_LT(growth.push(times_as_large(2), hundred(), kFrame), 1.1f);
  for (int t = 0; t < 120; ++t) growth.push(times_as_large(2), hundred(), kFrame);
  EXPECT_NEAR(growth.growth(), 2, 0.01);
  growth.reset();
  EXPECT_EQ(growth.growth(), 1);
}

TEST(GrowthEstimate, WhatIsSureCountsMost) {
  PoseLengths told = times_as_large(1, 0.01f);
  told.log_length[0] = std::log(400.0f), told.doubt[0] = 1;
  EXPECT_NEAR(GrowthEstimate().push(told, hundred(), kFrame), 1, 0.01);
}

TEST(GrowthEstimate, StaysWithinTenTimes) {
  EXPECT_NEAR(GrowthEstimate().push(times_as_large(1e6f), hundred(), kFrame), 10, 1e-3);
}

}  // namespace
}  // namespace understudy
