#include "retarget/body/joint_sight.hpp"

#include <gtest/gtest.h>

#include "tests/support/standing_person.hpp"

namespace understudy {
namespace {

using fixtures::StandingPerson;

class Sight : public testing::Test {
 protected:
  JointSight of(const LabelledPoints& cloud) const {
    return joint_sight(surface_about_joints(person_.cloud, person_.truth), cloud, person_.truth);
  }
  template <class Stays>
  JointSight where(Stays&& stays) const {
    LabelledPoints left = person_.cloud;
    keep_where(left, [&](int i) { return stays(Vec3(person_.cloud.points.row(i)), i); });
    return of(left);
  }

  StandingPerson person_;
};

TEST_F(Sight, AWholeBodyShowsAllJoints) {
  const JointSight sight = of(person_.cloud);
  EXPECT_EQ(sight.seen.sum(), kJointCount);
  EXPECT_LT(sight.away.maxCoeff(), 0.2f);
}

TEST_F(Sight, AThinnerCloudShowsAsMuch) {
  EXPECT_EQ(where([](const Vec3&, int i) { return (i * 2654435761u >> 16) % 8 == 0; }).seen.sum(),
            kJointCount);
}

TEST_F(Sight, JointsBelowACutAreNotSeenAndThoseAboveAre) {
  const float cut = person_.joint(LeftKnee).y() + 0.2f * person_.leg();
  const JointSight sight = where([&](const Vec3& x, int) { return x.y() > cut; });
  for (int j = 0; j < kJointCount; ++j) {
    const float above = person_.joint(j).y() - cut;
    EXPECT_EQ(sight.seen[j], above > 0 ? 1 : 0) << kJointNames[j];
    if (above < 0) EXPECT_NEAR(sight.away[j], -above / person_.leg(), 0.12f) << kJointNames[j];
  }
}

TEST_F(Sight, OneSideOfATrunkIsEnough) {
  for (const float side : {-1.0f, 1.0f}) {
    const JointSight sight =
        where([&](const Vec3& x, int) { return side * (x.z() - person_.joint(Spine2).z()) > 0; });
    for (const int j : {Pelvis, Spine1, Spine2, Spine3, LeftHip})
      EXPECT_EQ(sight.seen[j], 1) << kJointNames[j] << " from " << side;
  }
}

TEST_F(Sight, ThingsAndOtherLimbsDoNotShowAJoint) {
  LabelledPoints cloud = person_.cloud;
  for (int& part : cloud.parts)
    if (part == LeftWrist || part == LeftElbow) part = kNoBody;
  EXPECT_EQ(of(cloud).seen[LeftWrist], 0);
  EXPECT_EQ(of(cloud).seen[RightWrist], 1);
  for (int& part : cloud.parts) part = kNoBody;
  const JointSight nobody = of(cloud);
  EXPECT_EQ(nobody.seen.sum(), 0);
  EXPECT_GT(nobody.away.minCoeff(), 1);
}

}  // namespace
}  // namespace understudy
