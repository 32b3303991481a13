#include "retarget/rig/rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/rig/rig_edits.hpp"

namespace understudy {
namespace {

/// A post with an arm that turns, and a rod that slides out of the arm.
Rig crane() {
  Rig rig;
  rig.name = "crane";
  rig.joints = {{"post", -1, JointKind::Free, {0, 0, 0}, Vec3::UnitY()},
                {"arm", 0, JointKind::Hinge, {0, 1, 0}, Vec3::UnitZ()},
                {"rod", 1, JointKind::Slider, {1, 1, 0}, Vec3::UnitX()}};
  rig.surface.vertices.resize(3, 3);
  rig.surface.vertices << 0, 0.5f, 0, 0.5f, 1, 0, 1.5f, 1, 0;
  rig.skin = SkinWeights::rigid({0, 1, 2});
  return rig;
}

RigPose bent(const Rig& rig) {
  RigPose pose = rest_pose(rig);
  pose.turns[1] = rotation_from_axis_angle({0, 0, kPi / 2});
  pose.slides[2] = 0.25f;
  return pose;
}

TEST(Rig, ChildrenFollowTurnAndSlide) {
  const Rig rig = crane();
  const BoneMotions bones = bone_motions(rig, bent(rig));
  const Points posed = skinned(rig.surface.vertices, rig.skin, bones);
  EXPECT_LT((posed.row(0) - Eigen::RowVector3f(0, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((posed.row(1) - Eigen::RowVector3f(0, 1.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((posed.row(2) - Eigen::RowVector3f(0, 2.75f, 0)).norm(), 1e-6f);
  EXPECT_LT((joint_places(rig, bones).row(2) - Eigen::RowVector3f(0, 2.25f, 0)).norm(), 1e-6f);
}

TEST(Rig, PoseIsFoundFromTheMotionsOfItsBones) {
  const Rig rig = crane();
  RigPose pose = bent(rig);
  pose.turns[0] = rotation_from_axis_angle({0.3f, -0.4f, 0.9f});
  pose.root = {3, 2, 1};
  const RigPose again = pose_of(rig, bone_motions(rig, pose));
  EXPECT_LT((again.root - pose.root).norm(), 1e-5f);
  EXPECT_NEAR(again.slides[2], 0.25f, 1e-5f);
  for (size_t j = 0; j < 3; ++j) EXPECT_LT(geodesic_angle(again.turns[j], pose.turns[j]), 1e-3f);
}

TEST(Rig, PoseOfALongChainDoesNotDrift) {
  Rig rig;
  for (int j = 0; j < 60; ++j)
    rig.joints.push_back({"", j - 1, j == 0 ? JointKind::Free : JointKind::Ball,
                          Vec3(0.1f * static_cast<float>(j), 0, 0), Vec3::UnitY()});
  RigPose pose = rest_pose(rig);
  for (size_t j = 0; j < 60; ++j)
    pose.turns[j] = rotation_from_axis_angle({0.3f, std::sin(static_cast<float>(j)), 0.4f});
  const BoneMotions bones = bone_motions(rig, pose);
  const Points again = joint_places(rig, bone_motions(rig, pose_of(rig, bones)));
  EXPECT_LT((again - joint_places(rig, bones)).cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(Rig, HingeTurnsAboutItsAxisAlone) {
  const Rig rig = crane();
  BoneMotions bones = bone_motions(rig, rest_pose(rig));
  bones[1].R = rotation_from_axis_angle({0.2f, 0, 1.0f});
  const Vec3 turn = rotation_to_axis_angle(pose_of(rig, bones).turns[1]);
  EXPECT_LT(turn.head<2>().norm(), 1e-5f);
  EXPECT_NEAR(turn.z(), 1.0f, 0.02f);
}

TEST(Rig, ABoneThatCarriesNoOtherEndsAtItsFarthestVertex) {
  const std::vector<BoneTip> tips = bone_tips(crane());
  ASSERT_EQ(tips.size(), 1u);
  EXPECT_EQ(tips[0].joint, 2);
  EXPECT_LT((tips[0].rest - Vec3(1.5f, 1, 0)).norm(), 1e-5f);
}

TEST(SkinWeights, KeepTheFourLargest) {
  RowMatrix dense(1, 6);
  dense << 0.1f, 0.2f, 0.05f, 0.3f, 0.15f, 0.2f;
  const RowMatrix kept = SkinWeights::from(dense).dense(6);
  EXPECT_EQ(kept(0, 0), 0);
  EXPECT_EQ(kept(0, 2), 0);
  EXPECT_NEAR(kept(0, 3), 0.3f / 0.85f, 1e-6f);
  EXPECT_NEAR(kept.sum(), 1, 1e-6f);
}

TEST(RigEdits, AMergedBonesChildrenAndSkinAreItsParents) {
  Rig rig = crane();
  rig.skin.bones.row(1) << 0, 1, 2, 0;
  rig.skin.weights.row(1) << 0.25f, 0.5f, 0.25f, 0;
  EXPECT_EQ(merge_into_parent(rig, 1), (std::vector<int>{0, 0, 1}));
  ASSERT_EQ(rig.count(), 2);
  EXPECT_EQ(rig.joints[1].name, "rod");
  EXPECT_EQ(rig.joints[1].parent, 0);
  EXPECT_NO_THROW(check_rig(rig));
  const RowMatrix weights = rig.skin.dense(2);
  EXPECT_FLOAT_EQ(weights(1, 0), 0.75f);
  EXPECT_FLOAT_EQ(weights(1, 1), 0.25f);
  EXPECT_FLOAT_EQ(weights(2, 1), 1);
  EXPECT_THROW(merge_into_parent(rig, 0), Error);
  EXPECT_THROW(merge_into_parent(rig, 2), Error);
}

TEST(Rig, SaysWhatIsWrong) {
  Rig rig = crane();
  rig.joints[1].parent = 2;
  EXPECT_THROW(check_rig(rig), Error);
  rig = crane();
  rig.skin.bones(0, 0) = 3;
  EXPECT_THROW(check_rig(rig), Error);
  rig = crane();
  rig.surface.vertices.conservativeResize(2, 3);
  EXPECT_THROW(check_rig(rig), Error);
  EXPECT_NO_THROW(check_rig(crane()));
  EXPECT_THROW(bone_motions(crane(), {}), Error);
}

}  // namespace
}  // namespace understudy
