#include "retarget/discovery/inner_joints.hpp"

#include <gtest/gtest.h>

#include "bending_arm.hpp"

namespace understudy {
namespace {

/// A straight arm along x, 60 mm thick in y and 36 in z, both ways from the middle.
struct StraightArm {
  ThinnedFrame rest = thinned(bent_arm(0, 3), 1500, 4000, 3);
  DeformationGraph graph = deformation_graph(rest, 150);
};

Rig rig_with(const std::vector<Vec3>& joints) {
  Rig rig;
  for (const Vec3& at : joints)
    rig.joints.push_back(
        {"bone", static_cast<int>(rig.joints.size()) - 1, JointKind::Hinge, at, Vec3::UnitZ()});
  return rig;
}

TEST(InnerJoints, AJointOutsideGoesIntoTheThickOfTheBodyBesideIt) {
  const StraightArm arm;
  Rig rig = rig_with({{0.1f, 0, 0}, {0.3f, 0.12f, 0}, {0.6f, 0, 0.045f}});
  draw_joints_inside(arm.rest, arm.graph, rig);
  for (const int j : {1, 2}) {
    const RigJoint& joint = rig.joints[static_cast<size_t>(j)];
    EXPECT_NEAR(joint.rest.x(), j == 1 ? 0.3f : 0.6f, 0.04f) << j;
    EXPECT_LT(std::abs(joint.rest.y()), 0.04f) << j;
    EXPECT_LT(std::abs(joint.rest.z()), 0.015f) << j;
    EXPECT_EQ(joint.axis, Vec3(Vec3::UnitZ())) << j;
  }
}

TEST(InnerJoints, WhatLiesInsideStaysAndSoDoesTheRoot) {
  const std::vector<Vec3> joints = {{0.1f, 0.5f, 0}, {0.3f, 0.01f, 0}, {0.7f, -0.03f, 0.01f}};
  const StraightArm arm;
  Rig rig = rig_with(joints);
  draw_joints_inside(arm.rest, arm.graph, rig);
  for (size_t j = 0; j < joints.size(); ++j) EXPECT_EQ(rig.joints[j].rest, joints[j]) << j;
}

}  // namespace
}  // namespace understudy
