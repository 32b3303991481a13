#include "retarget/discovery/rig_refit.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/creature/creature.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"

namespace understudy {
namespace {

float mean_off(const DiscoveredRig& rig) {
  return std::accumulate(rig.off_m.begin(), rig.off_m.end(), 0.0f) / static_cast<float>(rig.off_m.size());
}

/// The arm taken for one bone.
const DiscoveredRig& stiff_arm() {
  static const DiscoveredRig rig = [] {
    DiscoveryOptions options;
    options.parts = 1;
    return discover(bending_arm(), options);
  }();
  return rig;
}

TEST(Refit, ABoneThatIsSplitWhereItBendsFollowsTheScans) {
  DiscoveredRig rig = stiff_arm();
  ASSERT_EQ(rig.found.rig.count(), 1);
  apply(rig, FitAgain{}, bending_arm());
  const float stiff = mean_off(rig);
  EXPECT_EQ(apply(rig, SplitBone{0, kElbow}, bending_arm()), (std::vector<int>{0}));
  ASSERT_EQ(rig.bones.size(), 2u);
  EXPECT_FLOAT_EQ(rig.bones[1].off_m, rig.bones[0].off_m);
  apply(rig, FitAgain{}, bending_arm());
  EXPECT_LT(mean_off(rig),
            0.7f * stiff);  // what remains is the surface's, made of scans that one bone blurred
  const auto turn = [&](size_t t) { return rig.found.motion.poses[t].turns[1]; };
  EXPECT_NEAR(geodesic_angle(turn(0), turn(kFrames - 1)), angle_at(kFrames - 1), 0.1f);
  EXPECT_GT(rig.bones[1].turned_deg, 30);
}

TEST(Refit, AnElbowThatWasMergedIsFoundAgain) {
  constexpr int kMoments = 9;
  DiscoveredRig rig;
  rig.found.rig = make_creature(CreatureKind::Arm, 101);
  int elbow = 0;
  while (rig.found.rig.joints[static_cast<size_t>(elbow)].name != "elbow") ++elbow;
  for (int t = 0; t < kMoments; ++t) {
    const float share = static_cast<float>(t) / (kMoments - 1);
    RigPose pose = rest_pose(rig.found.rig);
    const auto bend = [&](int joint, float angle) {
      pose.turns[static_cast<size_t>(joint)] =
          rotation_from_axis_angle(share * angle * rig.found.rig.joints[static_cast<size_t>(joint)].axis);
    };
    bend(elbow, 1.0f);
    bend(elbow - 1, -0.3f);
    rig.found.motion.poses.push_back(pose);
  }
  std::vector<Mesh> meshes;
  for (const Points& vertices : creature_surfaces(CreatureKind::Arm, rig.found.rig, rig.found.motion, 101))
    meshes.push_back({vertices, rig.found.rig.surface.faces});
  const ScanSequence scans =
      sequence(kMoments, [&](int t) -> Mesh { return meshes[static_cast<size_t>(t)]; });
  const Vec3 place = rig.found.rig.joints[static_cast<size_t>(elbow)].rest;
  ASSERT_TRUE(refit(rig, scans));
  const float whole = mean_off(rig);
  apply(rig, MergeBone{elbow}, scans);
  apply(rig, FitAgain{}, scans);
  const float merged = mean_off(rig);
  apply(rig, SplitBone{elbow - 1, place}, scans);
  apply(rig, FitAgain{}, scans);
  // Its own figure is what points on a smooth surface are from points of a scan of it.
  EXPECT_LT(mean_off(rig), 1.1f * whole);
  EXPECT_GT(merged, 2 * whole);
}

TEST(Refit, AMovedJointIsFittedAnew) {
  DiscoveredRig rig = found_arm();
  apply(rig, MoveJoint{1, kElbow + Vec3(0.12f, 0, 0)}, bending_arm());
  apply(rig, FitAgain{}, bending_arm());
  const float wrong = mean_off(rig);
  apply(rig, MoveJoint{1, kElbow}, bending_arm());
  apply(rig, FitAgain{}, bending_arm());
  EXPECT_LT(mean_off(rig), 0.8f * wrong);
}

TEST(Refit, EndedEarlyItChangesNothing) {
  DiscoveredRig rig = found_arm();
  for (RigPose& pose : rig.found.motion.poses) pose.root.x() += 0.01f;
  const DiscoveredRig before = rig;
  std::vector<float> shares;
  const auto stop = [&](float share) {
    shares.push_back(share);
    return share < 0.5f;
  };
  EXPECT_TRUE(apply(rig, FitAgain{}, bending_arm(), stop).empty());
  EXPECT_GE(shares.size(), 2u);
  EXPECT_LT(shares.back(), 1);
  EXPECT_EQ(rig.off_m, before.off_m);
  for (size_t t = 0; t < before.found.motion.poses.size(); ++t)
    EXPECT_EQ(rig.found.motion.poses[t].root, before.found.motion.poses[t].root);
}

TEST(Refit, GivesTheSameBytesForTheSameScans) {
  DiscoveredRig a = found_arm(), b = found_arm();
  ASSERT_TRUE(refit(a, bending_arm()));
  ASSERT_TRUE(refit(b, bending_arm()));
  EXPECT_EQ(a.off_m, b.off_m);
  for (size_t t = 0; t < a.found.motion.poses.size(); ++t)
    EXPECT_EQ(a.found.motion.poses[t].turns[1], b.found.motion.poses[t].turns[1]);
}

TEST(Refit, ATrimmedMotionIsFittedToItsOwnScans) {
  DiscoveredRig rig = found_arm();
  apply(rig, KeepFrames{4, 8}, bending_arm());
  EXPECT_EQ(rig.first_frame, 4);
  ASSERT_EQ(rig.off_m.size(), 5u);
  EXPECT_EQ(rig.off_m[0], found_arm().off_m[4]);
  apply(rig, KeepFrames{1, 4}, bending_arm());
  EXPECT_EQ(rig.first_frame, 5);
  apply(rig, FitAgain{}, bending_arm());
  ASSERT_EQ(rig.off_m.size(), 4u);
  for (size_t t = 0; t < 4; ++t)
    EXPECT_LT(
        geodesic_angle(rig.found.motion.poses[t].turns[1], found_arm().found.motion.poses[t + 5].turns[1]),
        0.06f);
  DiscoveredRig late = rig;
  late.first_frame = 8;
  EXPECT_THROW(apply(late, FitAgain{}, bending_arm()), Error);
}

TEST(Refit, AFrameWithoutPointsKeepsItsPose) {
  DiscoveredRig rig = found_arm();
  const ScanSequence scans = sequence(kFrames, [](int t) -> Mesh {
    if (t == 2) throw Error("cannot be read");
    return t == 7 ? Mesh{} : bent_arm(angle_at(t), static_cast<uint64_t>(t));
  });
  ASSERT_TRUE(refit(rig, scans));
  for (const size_t t : {2, 7}) {
    EXPECT_EQ(rig.found.motion.poses[t].root, found_arm().found.motion.poses[t].root);
    EXPECT_TRUE(rig.doubted[t]);
  }
  EXPECT_FALSE(rig.doubted[6]);
  rig.found.rig.surface = {};
  rig.found.rig.skin = SkinWeights::rigid({});
  EXPECT_THROW(refit(rig, scans), Error);
}

TEST(RigEdits, FiguresOfBonesGoWithThem) {
  DiscoveredRig rig = found_arm();
  const std::vector<FoundBone> before = rig.bones;
  EXPECT_EQ(apply(rig, RootAt{1}, bending_arm()), (std::vector<int>{1, 0}));
  ASSERT_EQ(rig.bones.size(), 2u);
  EXPECT_EQ(rig.bones[0].off_m, before[1].off_m);
  EXPECT_EQ(rig.bones[1].off_m, before[0].off_m);
  EXPECT_NEAR(rig.bones[1].turned_deg, before[1].turned_deg,
              0.1f);  // the same joint, seen from its other side
  apply(rig, MergeBone{1}, bending_arm());
  ASSERT_EQ(rig.bones.size(), 1u);
  EXPECT_EQ(rig.bones[0].turned_deg, 0);
}

}  // namespace
}  // namespace understudy
