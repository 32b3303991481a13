#include "retarget/creature/puppet.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// A trunk with one leg of two or three bones in the plane x = 0, its knee in front.
Rig one_leg(bool hock) {
  Rig rig;
  rig.name = "leg";
  rig.joints = {{"trunk", -1, JointKind::Free, {0, 1, 0}, Vec3::UnitY()},
                {"hip", 0, JointKind::Ball, {0, 0.9f, 0}, Vec3::UnitY()},
                {"knee", 1, JointKind::Hinge, {0, 0.5f, 0.1f}, Vec3::UnitX()}};
  if (hock) rig.joints.push_back({"hock", 2, JointKind::Hinge, {0, 0.25f, -0.05f}, Vec3::UnitX()});
  return rig;
}

Limb leg_of(const Rig& rig) {
  Limb limb;
  for (int j = 1; j < rig.count(); ++j) limb.joints.push_back(j);
  limb.end = limb.contact = Vec3(0, 0, 0);
  return limb;
}

TEST(Puppet, ALimbReachesItsTargetWithHingesThatTurnAboutTheirAxes) {
  for (const bool hock : {false, true}) {
    const Rig rig = one_leg(hock);
    const Limb limb = leg_of(rig);
    for (const Vec3& target : {Vec3(0, 0.05f, 0), Vec3(0.1f, 0.1f, 0.2f), Vec3(-0.15f, 0.2f, -0.1f)}) {
      Puppet puppet(rig);
      puppet.turn("trunk", Vec3(0.3f, 1, 0.2f), 0.4f);
      puppet.reach(limb, target);
      EXPECT_LT((puppet.bone(limb.joints.back())(limb.end) - target).norm(), 2e-3f);
      for (size_t j = 2; j < rig.joints.size(); ++j)
        EXPECT_LT((puppet.pose.turns[j] * rig.joints[j].axis - rig.joints[j].axis).norm(), 1e-5f);
      EXPECT_GT(puppet.bone(1)(rig.joints[2].rest).z(), target.z() - 0.2f) << "the knee stays in front";
    }
  }
}

TEST(Puppet, ALimbThatIsWhereItShouldBeStaysAsItIs) {
  const Rig rig = one_leg(true);
  Puppet puppet(rig);
  puppet.reach(leg_of(rig), Vec3::Zero());
  for (const Mat3& turn : puppet.pose.turns) EXPECT_LT((turn - Mat3::Identity()).norm(), 2e-3f);
}

TEST(Puppet, ATargetTooFarIsReachedForWithAStraightLimb) {
  const Rig rig = one_leg(false);
  const Limb limb = leg_of(rig);
  Puppet puppet(rig);
  puppet.reach(limb, Vec3(0, -2, 0));
  const Vec3 end = puppet.bone(2)(limb.end);
  EXPECT_LT(end.y(), 0);
  EXPECT_LT(std::abs(end.x()) + std::abs(end.z()), 0.02f);
}

TEST(Puppet, AnUnknownJointIsRefused) {
  const Rig rig = one_leg(false);
  Puppet puppet(rig);
  EXPECT_THROW(puppet.turn("wing", 1), Error);
}

}  // namespace
}  // namespace understudy
