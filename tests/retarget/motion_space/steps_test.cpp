// Steps: where they are found, and where not.
#include "retarget/motion_space/steps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy {
namespace {

using tests::KnownWalk;

TEST(Steps, AWalkHasOneForEachStrideOfEitherFoot) {
  const KnownWalk walk("walk");
  const auto steps = find_steps(walk.motion);
  ASSERT_GE(ssize(steps), 6);
  for (size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(static_cast<float>(steps[i].last - steps[i].first) / walk.motion.fps, 1.14f, 0.08f);
    EXPECT_LT(steps[i].distance, 0.05f);
    if (i == 0) continue;
    EXPECT_NE(steps[i].left_first, steps[i - 1].left_first);
    EXPECT_NEAR(static_cast<float>(steps[i].first - steps[i - 1].first) / walk.motion.fps, 0.57f, 0.08f);
  }
}

TEST(Steps, TheLeftLegComesToTheFrontWhereTheLeftFootStridesFirst) {
  const KnownWalk walk("walk");
  for (const Step& step : find_steps(walk.motion)) {
    const int later = step.first + (step.last - step.first) / 4;
    const Joints joints = forward_kinematics(walk.rest, walk.motion.poses[later]).joints;
    EXPECT_EQ(joints(LeftKnee, 2) > joints(RightKnee, 2), step.left_first) << step.first;
  }
}

TEST(Steps, AMirroredMotionHasThemOnTheOtherSide) {
  const KnownWalk walk("walk");
  const auto steps = find_steps(walk.motion), seen = find_steps(tests::mirrored(walk.motion));
  ASSERT_EQ(steps.size(), seen.size());
  for (size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].first, seen[i].first);
    EXPECT_EQ(steps[i].last, seen[i].last);
    EXPECT_NE(steps[i].left_first, seen[i].left_first);
    EXPECT_NEAR(steps[i].distance, seen[i].distance, 1e-4f);
  }
}

TEST(Steps, AreTheSameWhicheverWayAMotionGoesAndHoweverFastItIsCaptured) {
  const KnownWalk walk("walk");
  const auto steps = find_steps(walk.motion);
  EXPECT_EQ(find_steps(tests::turned(walk.motion, rotation_about_y(2), Vec3(3, 0, 1))).size(), steps.size());
  Motion slow = walk.motion;  // every other frame
  slow.fps = 15;
  slow.poses.clear();
  for (size_t t = 0; t < walk.motion.poses.size(); t += 2) slow.poses.push_back(walk.motion.poses[t]);
  const auto found = find_steps(slow);
  ASSERT_EQ(found.size(), steps.size());
  for (size_t i = 0; i < steps.size(); ++i) EXPECT_NEAR(2 * found[i].first, steps[i].first, 2);
}

TEST(Steps, NobodyStepsWhoStandsOrKeepsTheLegsStill) {
  const KnownWalk walk("walk");
  EXPECT_TRUE(find_steps({30, std::vector<Pose>(90, walk.motion.poses[20]), {}}).empty());
  Motion waving = walk.motion;
  for (Pose& pose : waving.poses)
    for (const int joint : {LeftHip, RightHip}) pose.local[joint].setIdentity();
  EXPECT_TRUE(find_steps(waving).empty());
  EXPECT_TRUE(find_steps({30, {}, {}}).empty());
}

TEST(Steps, WhatIsTooQuickTooSlowOrNothingLikeAWalkIsNone) {
  Motion walk = KnownWalk("walk").motion;
  walk.fps = 130;  // 0.26 s a step
  EXPECT_TRUE(find_steps(walk).empty());
  walk.fps = 10;  // 3.4 s
  EXPECT_TRUE(find_steps(walk).empty());
  Motion kicks{30, std::vector<Pose>(120), {}};  // straight legs to the side, one always before the other
  for (int t = 0; t < 120; ++t)
    for (const int side : {0, 1}) {
      const float forward = (side == 0 ? 0.4f : -0.4f) * std::sin(0.2f * static_cast<float>(t));
      kicks.poses[t].local[LeftHip + side] =
          rotation_from_axis_angle(Vec3(-forward, 0, side == 0 ? 1.4f : -1.4f));
    }
  EXPECT_TRUE(find_steps(kicks).empty());
}

TEST(Steps, FramesWithAFlagAreInNone) {
  Motion walk = KnownWalk("walk").motion;
  const auto steps = find_steps(walk);
  walk.flags.assign(walk.poses.size(), 0);
  EXPECT_EQ(find_steps(walk).size(), steps.size());
  const int flagged = steps[2].first + 3;
  walk.flags[flagged] = 1;
  const auto left = find_steps(walk);
  EXPECT_FALSE(left.empty());
  EXPECT_LT(left.size(), steps.size());
  for (const Step& step : left) EXPECT_TRUE(step.last < flagged || step.first > flagged);
  walk.flags.pop_back();
  EXPECT_THROW(find_steps(walk), Error);
}

TEST(Steps, TheirMovementBeginsAboveTheOriginAndFacesForward) {
  const KnownWalk walk("walk");
  const Motion there = tests::turned(walk.motion, rotation_about_y(-2.1f), Vec3(4, 0, -7));
  const TimedPoses movement = movement_of(there, 26, 60), plain = movement_of(walk.motion, 26, 60);
  ASSERT_EQ(movement.poses.size(), 35u);
  EXPECT_FLOAT_EQ(movement.duration(), 34 / 30.0f);
  EXPECT_EQ(movement.seconds.front(), 0);
  const Vec3 root = movement.poses.front().root;
  EXPECT_NEAR(std::hypot(root.x(), root.z()), 0, 1e-5f);
  EXPECT_NEAR(root.y(), walk.motion.poses[26].root.y(), 1e-5f);
  EXPECT_NEAR(heading_of(movement.poses.front().local[Pelvis]), 0, 1e-5f);
  EXPECT_LT(tests::farthest(walk.rest, {30, movement.poses, {}}, {30, plain.poses, {}}), 1e-4f);
  EXPECT_GT(movement.poses.back().root.z(), 0.5f);
}

TEST(Steps, ThereIsNoMovementOfFramesThatAreNotThere) {
  const Motion walk = KnownWalk("walk").motion;
  EXPECT_THROW(movement_of(walk, -1, 4), Error);
  EXPECT_THROW(movement_of(walk, 5, 4), Error);
  EXPECT_THROW(movement_of(walk, 0, static_cast<int>(ssize(walk.poses))), Error);
}

}  // namespace
}  // namespace understudy
