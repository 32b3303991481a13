#include "retarget/skeleton/foot_hold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/body/builtin_person.hpp"

namespace understudy {
namespace {

constexpr int kGlideFrames = 40, kGapFirst = 10, kGapLast = 29;

/// Somebody who is carried along as they stand, their balls 3 cm above the floor.
struct Glide {
  explicit Glide(float speed) {
    static const Joints person = builtin_person().joints;
    rest = person;
    motion.standing.resize(kGlideFrames, {false, false});
    for (int t = 0; t < kGlideFrames; ++t) {
      Pose& pose = motion.poses.emplace_back();
      pose.root = Vec3(0, 0.03f - rest(LeftFoot, 1), speed * static_cast<float>(t) / motion.fps);
    }
  }
  Vec3 ball(int t, int side = 0) const {
    return forward_kinematics(rest, motion.poses[t]).joints.row(LeftFoot + side).transpose();
  }
  Joints rest;
  Motion motion;
};

TEST(FootHold, AFastFootClearsTheFloor) {
  Glide glide(1.5f);
  hold_standing(glide.rest, kGapFirst, kGapLast, glide.motion);
  for (int t = kGapFirst + 6; t <= kGapLast - 6; ++t) {
    EXPECT_GT(glide.ball(t).y(), 0.045f) << t;
    EXPECT_LT(glide.ball(t).y(), 0.07f) << t;
  }
}

TEST(FootHold, OnlyTheFramesThatWereMadeChange) {
  Glide glide(1.5f);
  const Glide before = glide;
  hold_standing(glide.rest, kGapFirst, kGapLast, glide.motion);
  for (int t = 0; t < kGlideFrames; ++t)
    if (t < kGapFirst || t > kGapLast) EXPECT_EQ(glide.ball(t), before.ball(t)) << t;
}

TEST(FootHold, ASlowFootMayBeLow) {
  Glide glide(0.1f);
  hold_standing(glide.rest, kGapFirst, kGapLast, glide.motion);
  for (int t = 0; t < kGlideFrames; ++t) EXPECT_NEAR(glide.ball(t).y(), 0.03f, 1e-4f) << t;
}

TEST(FootHold, AFootThatStandsStaysOnTheFloorWhileTheOtherSwings) {
  Glide glide(0.3f);
  const int from = kGapFirst + 6, to = kGapLast - 6;
  for (int t = from; t <= to; ++t) glide.motion.standing[t] = {true, false};
  hold_standing(glide.rest, kGapFirst, kGapLast, glide.motion);
  for (int t = from; t <= to; ++t) EXPECT_NEAR(glide.ball(t).y(), 0.03f, 2e-3f) << t;
  for (int t = from; t < to; ++t)
    EXPECT_LT((glide.ball(t + 1) - glide.ball(t)).norm() * glide.motion.fps, 0.03f) << t;
}

}  // namespace
}  // namespace understudy
