// A rig is found from keypoints that a network of the kind is said to see.
#include "retarget/discovery/keypoint_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "retarget/base/error.hpp"
#include "tests/retarget/discovery/arm_finder.hpp"

namespace understudy {
namespace {

class KeypointStarts : public ::testing::TestWithParam<bool> {};

/// How far the nearest joint is from the elbow.
float off_elbow(const Rig& rig) {
  return (rig.rest_joints().rowwise() - kElbow.transpose())
      .bottomRows(rig.count() - 1)
      .rowwise()
      .norm()
      .minCoeff();
}

TEST_P(KeypointStarts, BonesAreWhatMovesNamedAfterTheirKeypoints) {
  DiscoveryOptions options;
  options.keypoints = std::make_shared<ArmFinder>(GetParam());
  const DiscoveredRig found = discover(bending_arm(), options);
  const Rig& rig = found.found.rig;
  EXPECT_LE(rig.count(), 3);
  EXPECT_GE(bone_named(rig, "keypoint 1"), 0);
  EXPECT_TRUE(bone_named(rig, "keypoint 2") >= 0 || bone_named(rig, "keypoint 3") >= 0);
  EXPECT_LT(off_elbow(rig), 0.04f);
  for (const float off : found.off_m) EXPECT_LT(off, 0.02f);
}
INSTANTIATE_TEST_SUITE_P(WithAndWithoutTurns, KeypointStarts, ::testing::Bool());

TEST(KeypointStart, FollowsWhatMovesTooFarBetweenTwoFramesForItsSurfaceAlone) {
  ScanSequence scans;
  scans.name = "arm", scans.count = 4, scans.fps = 4;
  scans.scan = [](int t) { return sparse_arm(t % 2 == 0 ? 0.0f : 1.9f, t); };
  DiscoveryOptions options;
  options.keypoints = std::make_shared<ArmFinder>(true);
  const DiscoveredRig found = discover(scans, options), alone = discover(scans);
  EXPECT_LT(off_elbow(found.found.rig), 0.04f);
  const auto worst = [](const DiscoveredRig& rig) {
    return *std::max_element(rig.off_m.begin(), rig.off_m.end());
  };
  EXPECT_LT(worst(found), 0.02f);
  EXPECT_LT(worst(found), 0.5f * worst(alone));
  EXPECT_LT(found.found.rig.count(), alone.found.rig.count()) << "what was not followed falls to pieces";
}

TEST(KeypointStart, NamesGoToTheBonesThatShareMostAndNoneTwice) {
  Rig rig;
  rig.joints.resize(3);
  rig.joints[2].name = "bone 2";
  const SkinWeights skin = SkinWeights::rigid({0, 0, 0, 1, 1, 2});
  name_after_keypoints({4, 4, 4, 4, 1, 4}, skin, rig);
  EXPECT_EQ(rig.joints[0].name, "keypoint 5");
  EXPECT_EQ(rig.joints[1].name, "keypoint 2");
  EXPECT_EQ(rig.joints[2].name, "bone 2") << "its keypoint is another's";
}

TEST(KeypointStart, EveryKeypointOwnsAPoint) {
  class Crowd final : public KeypointFinder {
   public:
    std::vector<FoundKeypoints> find(const std::vector<Mesh>& scans) override {
      FoundKeypoints one;
      one.places = Points::Zero(40, 3);  // all in one place, which the first one owns alone
      one.intensity.assign(40, 1);
      one.turns.assign(40, Mat3::Identity());
      std::vector<FoundKeypoints> all(scans.size(), one);
      for (size_t t = 0; t < all.size(); ++t)
        all[t].owner.assign(static_cast<size_t>(scans[t].vertices.rows()), 0);
      return all;
    }
    const std::vector<int>& parents() const override { return parents_; }
    const std::string& kind() const override { return kind_; }
    std::string name() const override { return "crowd"; }

   private:
    std::vector<int> parents_;
    std::string kind_;
  } crowd;
  std::vector<ThinnedFrame> frames;
  for (int t = 0; t < 3; ++t) frames.push_back(thinned(sparse_arm(0.2f, t), 200, 800, 1));
  const KeypointStart start = start_from_keypoints(frames, 1, 50, crowd);
  ASSERT_EQ(start.parts.count(), 40);
  for (int k = 0; k < 40; ++k)
    EXPECT_EQ(std::count(start.parts.of_point.begin(), start.parts.of_point.end(), k) > 0, true) << k;
  EXPECT_EQ(start.tracks.rest_frame, 1);
  EXPECT_EQ(start.tracks.motions.size(), 3u);
}

TEST(KeypointStart, OneFrameGivesARigAtRestWithJointsAtTheKeypoints) {
  ScanSequence one;
  one.name = "arm.ply", one.count = 1;
  one.scan = [](int) { return sparse_arm(0.6f, 1); };
  ArmFinder* const arm = new ArmFinder(true);
  const Points places = arm->find({one.scan(0)})[0].places;
  DiscoveryOptions options;
  options.keypoints.reset(arm);
  std::vector<PartsSoFar> shown;
  options.parts_found = [&](PartsSoFar parts) { shown.push_back(std::move(parts)); };
  const DiscoveredRig rig = discover(one, options);
  ASSERT_EQ(rig.found.rig.count(), 3);
  EXPECT_TRUE(rig.seen_once());
  EXPECT_EQ(rig.found.motion.poses.size(), 1u);
  for (const RigJoint& joint : rig.found.rig.joints) {
    const int k = std::stoi(joint.name.substr(9)) - 1;
    EXPECT_LT((joint.rest - places.row(k).transpose()).norm(), 0.02f) << joint.name;
    EXPECT_EQ(joint.parent < 0 ? JointKind::Free : JointKind::Ball, joint.kind);
  }
  EXPECT_LT(rig.off_m.at(0), 0.02f);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_EQ(shown[0].tree.size(), 3u);
  one.scan = [](int) { return Mesh{}; };
  EXPECT_NE(failure_of([&] { discover(one, options); }).find("arm.ply: its frame cannot be used"),
            std::string::npos);
  options.keypoints.reset();
  EXPECT_NE(failure_of([&] { discover(one, options); }).find("two frames or more"), std::string::npos);
}

TEST(KeypointStart, KeypointsAreShownBeforeTheirBonesAreFitted) {
  ScanSequence scans;
  scans.count = 6;
  scans.scan = [](int t) { return sparse_arm(0.2f * static_cast<float>(t), t); };
  DiscoveryOptions options;
  options.keypoints = std::make_shared<ArmFinder>(true);
  float share = 0, first = -1;
  options.progress = [&](const DiscoveryProgress& at) { return share = at.share, true; };
  options.parts_found = [&](const PartsSoFar&) { first = first < 0 ? share : first; };
  discover(scans, options);
  EXPECT_LE(first, 0.1f) << "as soon as the scans are read";
}

}  // namespace
}  // namespace understudy
