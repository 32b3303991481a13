#include "retarget/pipeline/foot_lock.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {
namespace {

/// A walk, the same with a root that drifts (its feet slide), and both as joints.
struct Walk {
  Joints rest = builtin_joints();
  Motion source, sliding;
  explicit Walk(float fps = 30) : source(builtin_motion("walk", rest, fps)), sliding(source) {
    for (size_t t = 0; t < sliding.poses.size(); ++t)
      sliding.poses[t].root += Vec3(0.08f, 0, -0.06f) * (static_cast<float>(t) / fps);
  }
  Joints seen(size_t t) const { return forward_kinematics(rest, source.poses[t]).joints; }
  JointSequence joints(const std::vector<Pose>& poses) const {
    JointSequence result;
    for (const Pose& pose : poses) result.push_back(forward_kinematics(rest, pose).joints);
    return result;
  }
  std::vector<Pose> locked(const FootLockOptions& options = {}) const {
    FootLock lock(options);
    std::vector<Pose> result;
    for (size_t t = 0; t < sliding.poses.size(); ++t)
      result.push_back(lock.push(sliding.poses[t], rest, 1 / source.fps, seen(t)));
    return result;
  }
  double skate(const std::vector<Pose>& poses) const { return foot_skate(joints(poses), source.fps); }
};

float fastest_turn(const std::vector<Pose>& poses, float fps) {
  float fastest = 0;
  for (size_t t = 1; t < poses.size(); ++t)
    for (const int j : {LeftHip, RightHip, LeftKnee, RightKnee})
      fastest = std::max(fastest, fps * geodesic_angle(poses[t - 1].local[static_cast<size_t>(j)],
                                                       poses[t].local[static_cast<size_t>(j)]));
  return fastest;
}

TEST(FootLock, HoldsStandingFeetAtAnyRate) {
  FootLockOptions firm;
  firm.creep_s = 100;
  for (const float fps : {30.0f, 60.0f, 120.0f}) {
    const Walk walk(fps);
    EXPECT_GT(walk.skate(walk.sliding.poses), 4 * walk.skate(walk.locked(firm))) << fps;
    EXPECT_GT(walk.skate(walk.sliding.poses), 1.8 * walk.skate(walk.locked())) << fps;
  }
}

TEST(FootLock, TakesTheTremorOfAStandingFootAway) {
  Walk walk;
  Rng rng(1);
  for (size_t t = 0; t < walk.sliding.poses.size(); ++t)
    walk.sliding.poses[t].root = walk.source.poses[t].root + 0.006f * Vec3(rng.normal(), 0, rng.normal());
  EXPECT_GT(walk.skate(walk.sliding.poses), 10 * walk.skate(walk.locked()));
}

TEST(FootLock, DoesNotMakeLegsSnap) {
  const Walk walk;
  EXPECT_LT(fastest_turn(walk.locked(), 30), 1.3f * fastest_turn(walk.sliding.poses, 30));
}

TEST(FootLock, LeavesFeetThatDoNotSlide) {
  Walk walk;
  walk.sliding = walk.source;
  EXPECT_LT(mean_joint_error(walk.joints(walk.locked()), walk.joints(walk.source.poses)), 5e-4);
}

TEST(FootLock, ChangesTheLegsOnlyAndKeepsTheFeetsRotations) {
  const Walk walk;
  const auto locked = walk.locked();
  for (size_t t = 0; t < locked.size(); ++t) {
    const auto before = forward_kinematics(walk.rest, walk.sliding.poses[t]),
               after = forward_kinematics(walk.rest, locked[t]);
    for (const int j : {Pelvis, Head, LeftWrist, RightWrist})
      EXPECT_LT((before.joints.row(j) - after.joints.row(j)).norm(), 1e-5f);
    for (const int j : {LeftAnkle, RightAnkle, LeftFoot})
      EXPECT_LT(geodesic_angle(before.global[static_cast<size_t>(j)], after.global[static_cast<size_t>(j)]),
                2e-3f);
  }
}

TEST(FootLock, LooksOnlyBack) {
  const Walk walk;
  FootLock lock;
  const auto all = walk.locked();
  for (size_t t = 0; t < 40; ++t) {
    const Pose now = lock.push(walk.sliding.poses[t], walk.rest, 1 / 30.0f, walk.seen(t));
    for (size_t j = 0; j < kJointCount; ++j) EXPECT_EQ(now.local[j], all[t].local[j]);
  }
  lock.reset();
  const Pose first = lock.push(walk.sliding.poses[0], walk.rest, 1 / 30.0f, walk.seen(0));
  for (size_t j = 0; j < kJointCount; ++j) EXPECT_EQ(first.local[j], all[0].local[j]);
}

TEST(FootLock, LetsGoWithinTheReleaseTime) {
  const Walk walk;
  FootLock lock;
  for (size_t t = 0; t < 15; ++t) lock.push(walk.sliding.poses[t], walk.rest, 1 / 30.0f, walk.seen(t));
  ASSERT_TRUE(lock.standing()[0] || lock.standing()[1]);
  Joints air = walk.seen(15);
  Pose last;
  for (int t = 0; t < 60; ++t) {  // the source flies up: nothing stands
    air.col(1).array() += 0.1f;
    last = lock.push(walk.sliding.poses[15], walk.rest, 1 / 30.0f, air);
  }
  EXPECT_FALSE(lock.standing()[0] || lock.standing()[1]);
  for (size_t j = 0; j < kJointCount; ++j)
    EXPECT_LT(geodesic_angle(last.local[j], walk.sliding.poses[15].local[j]), 1e-4f);
}

TEST(FootLock, SlipsRatherThanStretch) {
  Walk walk;
  for (size_t t = 0; t < walk.sliding.poses.size(); ++t)
    walk.sliding.poses[t].root.x() += 0.1f * static_cast<float>(t);
  FootLockOptions options;
  const auto before = walk.joints(walk.sliding.poses), after = walk.joints(walk.locked(options));
  for (size_t t = 0; t < before.size(); ++t)
    for (const int j : {LeftAnkle, RightAnkle})
      EXPECT_LT((before[t].row(j) - after[t].row(j)).norm(),
                options.max_offset_m * leg_length(walk.rest) / 0.8f + 1e-3f);
}

TEST(FootLock, RefusesJointsThatAreNotFinite) {
  const Walk walk;
  FootLock lock;
  Joints bad = walk.seen(0);
  bad(3, 1) = NAN;
  EXPECT_THROW(lock.push(walk.sliding.poses[0], walk.rest, 1 / 30.0f, bad), Error);
}

}  // namespace
}  // namespace understudy
