// What goes out: bones in the VMC protocol's axes, and the way to the T-pose and back.
#include "retarget/live/sent_pose.hpp"

#include <gtest/gtest.h>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

Pose turned_pose() {
  Pose pose;
  pose.root = Vec3(0.5f, 0.9f, -2);
  for (int j = 0; j < kJointCount; ++j)
    pose.local[j] = rotation_from_axis_angle(Vec3(0.1f * static_cast<float>(j), 0.4f, -0.2f));
  return pose;
}

Joints some_rest() {
  Joints rest = Joints::Zero();
  for (int j = 0; j < kJointCount; ++j)
    rest.row(j) = Vec3(0.1f * static_cast<float>(j), 1, 0.05f * static_cast<float>(j % 3)).transpose();
  return rest;
}

/// Positions of the joints as an engine works them out, in its own left-handed axes, then mirrored back.
Joints joints_in_engine(const std::vector<VmcBone>& bones) {
  std::array<Eigen::Quaternionf, kJointCount> turn;
  std::array<Vec3, kJointCount> place;
  Joints joints;
  for (int j = 0; j < kJointCount; ++j) {
    const VmcBone& bone = bones[static_cast<size_t>(j) + 1];
    const VmcBone& root = bones[0];
    const Eigen::Quaternionf up = kParents[j] < 0 ? root.rotation : turn[kParents[j]];
    const Vec3 from = kParents[j] < 0 ? root.position : place[kParents[j]];
    place[j] = from + up * bone.position;
    turn[j] = up * bone.rotation;
    joints.row(j) = Vec3(-place[j].x(), place[j].y(), place[j].z()).transpose();
  }
  return joints;
}

TEST(VmcBones, AnEngineThatAppliesThemPutsEveryJointWhereWeDo) {
  const Joints rest = some_rest();
  const Pose pose = turned_pose();
  const Joints ours = forward_kinematics(rest, pose).joints;
  EXPECT_LT((joints_in_engine(vmc_bones(rest, pose)) - ours).cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(VmcBones, TurnsAreMirrored) {
  Pose pose;
  pose.local[LeftElbow] = rotation_from_axis_angle(Vec3(0, 0.5f, 0));  // to the left, in our axes
  const VmcBone bone = vmc_bones(some_rest(), pose)[LeftElbow + 1];
  EXPECT_STREQ(bone.name, "LeftLowerArm");
  EXPECT_NEAR(bone.rotation.y(), -std::sin(0.25f), 1e-5f);
  EXPECT_NEAR(bone.rotation.w(), std::cos(0.25f), 1e-5f);
}

TEST(VmcMessages, AreTheProtocols) {
  SentPose sent;
  sent.seconds = 2;
  sent.is_tracked = false;
  const auto messages = vmc_messages(some_rest(), sent);
  ASSERT_EQ(messages.size(), 25u);
  EXPECT_EQ(messages[0].path, "/VMC/Ext/OK");
  EXPECT_EQ(std::get<int32_t>(messages[0].values[3]), 0);
  EXPECT_EQ(std::get<float>(messages[1].values[0]), 2.0f);
  EXPECT_EQ(messages[2].path, "/VMC/Ext/Root/Pos");
  EXPECT_EQ(std::get<std::string>(messages[3].values[0]), "Hips");
  EXPECT_EQ(messages[24].values.size(), 8u);
}

TEST(TPoseBlend, StandsInTPoseSomeSecondsAfterTheSourceIsLostAndComesBack) {
  TPoseBlend blend(1);
  const Pose pose = turned_pose();
  const auto bend = [](const Pose& p) { return geodesic_angle(p.local[LeftElbow], Mat3::Identity()); };
  const float whole = bend(pose);
  Pose shown = blend.push(pose, true, 0.1f);
  EXPECT_EQ(bend(shown), whole);
  for (int i = 0; i < 19; ++i) shown = blend.push(pose, false, 0.1f);
  EXPECT_EQ(bend(shown), whole);
  for (int i = 0; i < 30; ++i) shown = blend.push(pose, false, 0.1f);
  EXPECT_NEAR(bend(shown), 0, 1e-3f);
  EXPECT_NEAR(shown.root.y(), 1, 1e-5f);
  EXPECT_NEAR(heading_of(shown.local[Pelvis]), heading_of(pose.local[Pelvis]), 1e-4f);
  shown = blend.push(pose, true, 0.1f);
  EXPECT_GT(bend(shown), 0.01f);
  EXPECT_LT(bend(shown), whole);
  for (int i = 0; i < 6; ++i) shown = blend.push(pose, true, 0.1f);
  EXPECT_EQ(bend(shown), whole);
}

}  // namespace
}  // namespace understudy
