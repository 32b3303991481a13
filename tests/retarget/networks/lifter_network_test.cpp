// The shipped weights on the built-in person, whom they have never seen.
#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/networks/networks.hpp"
#include "tests/support/lifted_walk.hpp"

namespace understudy {
namespace {

std::unique_ptr<Lifter> shipped_lifter() {
  auto lifter = nn::load_lifter(US_SOURCE_DIR "/assets/weights");
  LiftView view;
  view.canvas = {720, 720};
  lifter->reset(view);
  return lifter;
}

std::vector<Extraction> lifted(Lifter& lifter, const LiftedWalk& walk) {
  std::vector<Extraction> all;
  for (const FlatPose& pose : walk.poses) all.push_back(lifter.push(pose, walk.dt));
  return all;
}

bool same(const Extraction& a, const Extraction& b) {
  return a.joints == b.joints && (a.confidence == b.confidence).all() && *a.global == *b.global;
}

double error_mm(const std::vector<Extraction>& lifted, const LiftedWalk& walk) {
  JointSequence predicted, truth;
  for (size_t t = 0; t < lifted.size(); ++t) {
    predicted.push_back(lifted[t].joints);
    truth.push_back(walk.truth[t].joints);
  }
  return 1000 * mean_joint_error(scaled_joints(predicted, truth), truth);
}

TEST(LifterNetwork, LiftsAWalkFromWhereverItIsSeen) {
  for (const float yaw : {0.0f, 0.8f, 1.6f, 3.0f}) {
    const LiftedWalk walk = lifted_walk(yaw);
    EXPECT_LT(error_mm(lifted(*shipped_lifter(), walk), walk), 90) << yaw;
  }
}

TEST(LifterNetwork, KnowsWhichJointsItDoesNotSee) {
  LiftedWalk walk = lifted_walk(0.5f, 20);
  const std::vector<Extraction> whole = lifted(*shipped_lifter(), walk);
  for (FlatPose& pose : walk.poses)
    for (const int p : {body25::LeftElbow, body25::LeftWrist}) pose.forget(p);
  const std::vector<Extraction> cut = lifted(*shipped_lifter(), walk);
  EXPECT_LT(cut.back().confidence[LeftWrist], whole.back().confidence[LeftWrist]);
  EXPECT_EQ(cut.back().visibility[LeftWrist], 0);
  EXPECT_EQ(cut.back().visibility[RightWrist], 1);
}

TEST(LifterNetwork, NoSkeletonDependsOnALaterPose) {
  const LiftedWalk walk = lifted_walk(0.5f, 20), other = lifted_walk(2, 20);
  LiftedWalk mixed = walk;
  for (size_t t = 12; t < 20; ++t) mixed.poses[t] = other.poses[t];
  const std::vector<Extraction> a = lifted(*shipped_lifter(), walk), b = lifted(*shipped_lifter(), mixed);
  for (size_t t = 0; t < 12; ++t) EXPECT_TRUE(same(a[t], b[t])) << t;
  EXPECT_FALSE(same(a[12], b[12]));
}

TEST(LifterNetwork, RemembersAndForgets) {
  const LiftedWalk walk = lifted_walk(0.5f, 10);
  const auto lifter = shipped_lifter();
  const std::vector<Extraction> first = lifted(*lifter, walk);
  const std::any before = lifter->memory();
  const Extraction next = lifter->push(walk.poses[3], walk.dt);
  lifter->restore(before);
  EXPECT_TRUE(same(lifter->push(walk.poses[3], walk.dt), next));
  LiftView view;
  view.canvas = {720, 720};
  lifter->reset(view);
  const std::vector<Extraction> again = lifted(*lifter, walk);
  for (size_t t = 0; t < first.size(); ++t) EXPECT_TRUE(same(first[t], again[t])) << t;
}

TEST(LifterNetwork, ARefusedPoseLeavesNoTrace) {
  const LiftedWalk walk = lifted_walk(0.5f, 6);
  const auto plain = shipped_lifter(), disturbed = shipped_lifter();
  for (const FlatPose& pose : walk.poses) {
    EXPECT_THROW(disturbed->push({}, walk.dt), Error);
    EXPECT_TRUE(same(plain->push(pose, walk.dt), disturbed->push(pose, walk.dt)));
  }
}

TEST(LifterNetwork, TenThousandFramesEndAsTheyBegan) {
  const LiftedWalk walk = lifted_walk(0.8f, 1000);
  const auto lifter = shipped_lifter();
  const auto round = [&] {
    const std::vector<Extraction> all = lifted(*lifter, walk);
    return error_mm({all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end()},
                    {{walk.poses.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), walk.poses.end()},
                     {walk.truth.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), walk.truth.end()},
                     walk.lengths,
                     walk.dt});
  };
  const double begins = round();
  double ends = 0;
  for (size_t frames = walk.poses.size(); frames < 10000; frames += walk.poses.size()) ends = round();
  EXPECT_NEAR(ends, begins, 5);
}

}  // namespace
}  // namespace understudy
