#include "retarget/discovery/rig_figures.hpp"

#include <gtest/gtest.h>

#include "retarget/discovery/rig_refit.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"

namespace understudy {
namespace {

/// The arm, its forearm hidden in every second frame, or all of it there.
Mesh half_hidden(int t) {
  Mesh scan = bent_arm(angle_at(t), static_cast<uint64_t>(t));
  if (t % 2 == 1) scan.vertices.conservativeResize(2000, 3);  // the upper arm's
  return scan;
}

/// Its true bones at rest.
Rig arm_rig() {
  Rig rig;
  rig.joints = {{"upper", -1, JointKind::Free, Vec3::Zero()},
                {"fore", 0, JointKind::Hinge, kElbow, Vec3::UnitZ()}};
  rig.surface = bent_arm(0, 99);
  std::vector<int> bones(4000, 0);
  std::fill(bones.begin() + 2000, bones.end(), 1);
  rig.skin = SkinWeights::rigid(bones);
  return rig;
}

TEST(BoneDistances, ABoneIsSeenInTheFramesThatDoNotHideIt) {
  const Rig rig = arm_rig();
  const FittedSurface surface{rig.surface.vertices, Points::Zero(4000, 3), rig.skin};
  BoneDistances distances(3);  // one more, which moves nothing
  for (int t = 0; t < kFrames; ++t) {
    RigPose pose = rest_pose(rig);
    pose.turns[1] = rotation_from_axis_angle({0, 0, angle_at(t)});
    const ThinnedFrame scan = thinned(half_hidden(t), 2000, 4000, 7);
    distances.add(surface.skin, distances_to(scan, surface, bone_motions(rig, pose)));
  }
  std::vector<FoundBone> bones(3);
  distances.tell(bones);
  EXPECT_EQ(bones[0].seen_share, 1);
  EXPECT_EQ(bones[1].seen_share, 0.5f);
  EXPECT_EQ(bones[2].seen_share, 0);
  EXPECT_LT(bones[0].off_m, 0.01f);
  EXPECT_GT(bones[1].off_m, 0.05f) << "where it is hidden it is far from what is seen";
}

TEST(BoneDistances, AFifthOfItsPointsIsEnough) {
  SkinWeights skin = SkinWeights::rigid(std::vector<int>(10, 0));
  const auto share = [&](int shown) {
    ScanDistances one{Eigen::VectorXf::Constant(10, 0.031f), 0.01f};
    one.off.head(shown).setConstant(0.029f);
    BoneDistances distances(1);
    distances.add(skin, one);
    std::vector<FoundBone> bones(1);
    distances.tell(bones);
    return bones[0].seen_share;
  };
  EXPECT_EQ(share(1), 0);
  EXPECT_EQ(share(2), 1);
}

TEST(BoneDistances, WithoutAFrameNothingIsKnown) {
  std::vector<FoundBone> bones(1);
  BoneDistances(1).tell(bones);
  EXPECT_LT(bones[0].seen_share, 0);
}

TEST(BoneDistances, AreToldOfARigThatIsFittedAgain) {
  DiscoveredRig rig;
  rig.found.rig = arm_rig();
  for (int t = 0; t < kFrames; ++t) {
    RigPose pose = rest_pose(rig.found.rig);
    pose.turns[1] = rotation_from_axis_angle({0, 0, angle_at(t)});
    rig.found.motion.poses.push_back(pose);
  }
  ASSERT_TRUE(refit(rig, sequence(kFrames, half_hidden)));
  EXPECT_EQ(rig.bones[0].seen_share, 1);
  EXPECT_NEAR(rig.bones[1].seen_share, 0.5f, 0.11f) << "a frame more or less";
}

}  // namespace
}  // namespace understudy
