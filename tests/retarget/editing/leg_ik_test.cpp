#include "retarget/skeleton/limb_ik.hpp"

#include <gtest/gtest.h>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

struct Walker {
  Joints rest = builtin_joints();
  Motion motion = builtin_motion("walk", rest);
};

Vec3 joint(const PosedSkeleton& posed, int j) {
  return posed.joints.row(j).transpose();
}

TEST(PlaceAnkle, BringsTheAnkleThere) {
  const Walker w;
  for (const Pose& original : w.motion.poses)
    for (const int side : {0, 1}) {
      Pose pose = original;
      const Leg leg = Leg::of(side);
      const Vec3 to = joint(forward_kinematics(w.rest, pose), leg.ankle) + Vec3(0.03f, 0.06f, -0.04f);
      const Vec3 reached = place_ankle(w.rest, side, to, pose);
      EXPECT_LT((joint(forward_kinematics(w.rest, pose), leg.ankle) - reached).norm(), 1e-4f);
      EXPECT_LT((reached - to).norm(), 2e-3f);
    }
}

TEST(PlaceAnkle, KeepsTheFootsWorldRotationAndTheBones) {
  const Walker w;
  Pose pose = w.motion.poses[20];
  const auto before = forward_kinematics(w.rest, pose);
  place_ankle(w.rest, 0, joint(before, LeftAnkle) + Vec3(0.05f, 0.05f, 0.02f), pose);
  const auto after = forward_kinematics(w.rest, pose);
  EXPECT_LT(geodesic_angle(before.global[LeftAnkle], after.global[LeftAnkle]), 1e-3f);
  EXPECT_NEAR(leg_length(after.joints), leg_length(w.rest), 1e-4f);
  EXPECT_LT((joint(before, RightFoot) - joint(after, RightFoot)).norm(), 1e-6f);
}

TEST(PlaceAnkle, LeavesAPoseThatNeedsNothing) {
  const Walker w;
  Pose pose = w.motion.poses[33];
  place_ankle(w.rest, 1, joint(forward_kinematics(w.rest, pose), RightAnkle), pose);
  for (int j = 0; j < kJointCount; ++j)
    EXPECT_LT(geodesic_angle(pose.local[j], w.motion.poses[33].local[j]), 1e-6f);
}

TEST(PlaceAnkle, BendsAStraightLegForward) {
  const Joints rest = builtin_joints();
  Pose pose;  // the T-pose
  const auto before = forward_kinematics(rest, pose);
  place_ankle(rest, 0, joint(before, LeftAnkle) + Vec3(0, 0.2f, 0), pose);
  const auto after = forward_kinematics(rest, pose);
  const Vec3 middle = 0.5f * (joint(after, LeftHip) + joint(after, LeftAnkle));
  EXPECT_GT(joint(after, LeftKnee).z() - middle.z(), 0.1f);
  EXPECT_NEAR(joint(after, LeftKnee).x(), joint(before, LeftKnee).x(), 0.04f);
}

TEST(PlaceAnkle, ChangesLittleForALittleWayEvenOutOfReach) {
  const Walker w;
  for (const int frame : {0, 15, 40}) {
    Pose last;
    for (int i = 0; i <= 200; ++i) {  // a way of 40 cm straight down: out of reach of any leg
      Pose pose = w.motion.poses[frame];
      const Vec3 from = joint(forward_kinematics(w.rest, pose), LeftAnkle) + Vec3(0, 0.15f, 0);
      const Vec3 to = from - Vec3(0, 0.002f * static_cast<float>(i), 0);
      const Vec3 reached = place_ankle(w.rest, 0, to, pose);
      EXPECT_TRUE(reached.allFinite());
      if (i > 0) {
        EXPECT_LT(geodesic_angle(last.local[LeftKnee], pose.local[LeftKnee]), 0.04f) << frame << " " << i;
        EXPECT_LT(geodesic_angle(last.local[LeftHip], pose.local[LeftHip]), 0.04f) << frame << " " << i;
      }
      last = pose;
    }
  }
}

TEST(PlaceAnkle, SurvivesATargetInTheHip) {
  const Joints rest = builtin_joints();
  Pose pose;
  const Vec3 reached = place_ankle(rest, 0, joint(forward_kinematics(rest, pose), LeftHip), pose);
  EXPECT_TRUE(reached.allFinite());
  for (const Mat3& R : pose.local) EXPECT_TRUE(R.allFinite());
}

}  // namespace
}  // namespace understudy
