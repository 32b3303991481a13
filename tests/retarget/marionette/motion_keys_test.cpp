#include "retarget/marionette/motion_keys.hpp"

#include "retarget/base/error.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// Upper arm 1 m along x, fore arm 1 m, and a tip.
Rig two_bones() {
  Rig rig;
  rig.name = "arm";
  rig.joints = {{"upper", -1, JointKind::Free, Vec3::Zero(), Vec3::UnitY()},
                {"fore", 0, JointKind::Ball, Vec3(1, 0, 0), Vec3::UnitY()},
                {"tip", 1, JointKind::Ball, Vec3(2, 0, 0), Vec3::UnitY()}};
  return rig;
}

RigPose bent(const Rig& rig, float elbow, const Vec3& root = Vec3::Zero()) {
  RigPose pose = rest_pose(rig);
  pose.root = root;
  pose.turns[1] = rotation_from_axis_angle({0, 0, elbow});
  return pose;
}

TEST(MotionKeys, SlerpTurnsEvenlyAndLerpLeadsJointsStraight) {
  const Rig rig = two_bones();
  const std::vector<PoseKey> keys = {{0, bent(rig, 0)}, {4, bent(rig, kPi / 2, {4, 0, 0})}};
  const std::vector<RigPose> even = slerp_between(rig, keys, 6), straight = lerp_between(rig, keys, 6);
  EXPECT_NEAR(rotation_to_axis_angle(even[1].turns[1]).z(), kPi / 8, 1e-5);
  EXPECT_NEAR(even[1].root.x(), 1, 1e-6);
  EXPECT_NEAR(even[5].root.x(), 4, 1e-6);  // after the last key it stands
  // The tip goes from (2, 0) to (1 + 4, 1); a quarter of the way, less what the root went, it is at
  // (2 - 0.25, 0.25) with the elbow at (1, 0): the fore arm looks along (0.75, 0.25).
  EXPECT_NEAR(rotation_to_axis_angle(straight[1].turns[1]).z(), std::atan2(0.25, 0.75), 1e-5);
}

TEST(MotionKeys, APoseIsFoundFromThePlacesOfItsJoints) {
  const Rig rig = make_creature(CreatureKind::Hand, 4);
  const RigMotion motion = creature_motion(CreatureKind::Hand, rig, 0, 20, 30, 4);
  for (const RigPose& pose : motion.poses) {
    const Points places = joint_places(rig, bone_motions(rig, pose));
    const Points found = joint_places(rig, bone_motions(rig, pose_at_places(rig, places, pose)));
    EXPECT_LT((found - places).rowwise().norm().maxCoeff(), 2e-3f);
  }
}

TEST(MotionKeys, WhatIsMissingIsSpreadBetweenKeys) {
  const Rig rig = two_bones();
  std::vector<RigPose> poses(5, bent(rig, 0));
  RigPose turned = bent(rig, 0.4f, {2, 1, 0});
  turned.turns[0] = rotation_about_y(0.8f);
  meet_keys(rig, 30, {{0, bent(rig, 0)}, {4, turned}}, poses);
  EXPECT_NEAR(rotation_to_axis_angle(poses[2].turns[1]).z(), 0.2, 1e-5);
  EXPECT_NEAR(heading_of(poses[2].turns[0]), 0.4, 1e-5);
  EXPECT_NEAR(poses[2].root.x(), 1, 1e-5);
  EXPECT_NEAR(poses[1].root.y(), 0.25, 1e-5);
  EXPECT_EQ((poses[4].turns[0] - turned.turns[0]).norm(), 0);
}

TEST(MotionKeys, BeforeAndAfterKeysTheWholeIsMovedAndPosesFade) {
  const Rig rig = two_bones();
  std::vector<RigPose> poses(31, bent(rig, 0));
  meet_keys(rig, 30, {{15, bent(rig, 0.5f, {3, 0, 1})}}, poses);
  EXPECT_NEAR(poses[0].root.x(), 3, 1e-5);
  EXPECT_NEAR(rotation_to_axis_angle(poses[0].turns[1]).z(), 0, 1e-5);
  EXPECT_NEAR(rotation_to_axis_angle(poses[20].turns[1]).z(), 0.25, 1e-4);
}

TEST(MotionKeys, KeysThatDoNotFitAreRefused) {
  const Rig rig = two_bones();
  EXPECT_THROW(check_keys(rig, 5, {{5, bent(rig, 0)}}), Error);
  EXPECT_THROW(check_keys(rig, 5, {{3, bent(rig, 0)}, {3, bent(rig, 0)}}), Error);
  EXPECT_THROW(check_keys(rig, 5, {{0, RigPose{}}}), Error);
  EXPECT_THROW(slerp_between(rig, {}, 5), Error);
}

}  // namespace
}  // namespace understudy
