#include "retarget/keypoints/track_jitter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/rng.hpp"
#include "tests/retarget/keypoints/support.hpp"

namespace understudy::test {
namespace {

/// Somebody who sways by 40 pixels, twice a second, seen with this error.
FlatPose swaying(int frame, float error, Rng& rng) {
  FlatPose pose = standing({500, 600}, 400);
  const Vec2 away(40 * std::sin(4 * kPi * static_cast<float>(frame) / 30), 0);
  for (int point = 0; point < kBodyPoints; ++point)
    pose.set(point, pose.at(point) + away + error * Vec2(rng.normal(), rng.normal()), 1);
  return pose;
}

float measured(float error) {
  TrackJitter jitter;
  Rng rng(1);
  for (int frame = 0; frame < 90; ++frame) jitter.push(swaying(frame, error, rng), 1 / 30.0f);
  return jitter.pixels();
}

TEST(TrackJitter, IsTheErrorOfTheSightings) {
  EXPECT_NEAR(measured(4), 4, 0.8f);
  EXPECT_NEAR(measured(12), 12, 2);
}

TEST(TrackJitter, AMovementIsNone) {
  EXPECT_LT(measured(0), 1);
}

TEST(TrackJitter, FramesFarApartSayNothing) {
  TrackJitter jitter;
  Rng rng(1);
  for (int frame = 0; frame < 30; ++frame) jitter.push(swaying(frame, 4, rng), 0.2f);
  EXPECT_LT(jitter.pixels(), 0);
}

}  // namespace
}  // namespace understudy::test
