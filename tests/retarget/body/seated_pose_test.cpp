#include "retarget/body/seated_pose.hpp"

#include <gtest/gtest.h>

#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

TEST(SeatedPose, HasThighsForwardsShinsDownAndTheHeadingThatItHad) {
  const Joints rest = builtin_joints();
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    std::vector<Pose> poses(2);
    poses[0].local[Pelvis] = rotation_about_y(1);
    poses[1].local[Pelvis] = rotation_about_y(1) * rotation_from_axis_angle(Vec3(0.5f, 0, 0));
    poses[1].local[LeftElbow] = rotation_about_y(0.7f);
    sit_down(poses, rng);
    EXPECT_EQ(poses[0].local[LeftHip], poses[1].local[LeftHip]);
    EXPECT_EQ(poses[1].local[LeftElbow], rotation_about_y(0.7f));
    const Joints sits = forward_kinematics(rest, poses[0]).joints;
    const Vec3 forwards = rotation_about_y(1).col(2);
    for (const int hip : {LeftHip, RightHip}) {
      const int knee = hip + LeftKnee - LeftHip, ankle = hip + LeftAnkle - LeftHip;
      const Vec3 thigh = (sits.row(knee) - sits.row(hip)).transpose();
      EXPECT_GT(thigh.normalized().dot(forwards), 0.6f);
      EXPECT_LT(sits(ankle, 1), sits(knee, 1) - 0.15f);
    }
    EXPECT_GT(sits(Head, 1), sits(Pelvis, 1) + 0.4f);
  }
}

}  // namespace
}  // namespace understudy
