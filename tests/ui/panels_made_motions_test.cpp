// The section of further motions of the panel Bones with mouse and keys.
#include "tests/ui/support/panels_test.hpp"
#include "tests/ui/support/three_bones.hpp"

namespace understudy::ui {
namespace {

class MadeMotionsPanel : public PanelsTest {
 protected:
  MadeMotionsPanel() {
    input.size = {380, 2400};
    session.jobs.clear();
    session.working = false;
    session.playback.in = session.playback.out = -1;
    session.document.bones.wanted = true;
    session.bones.rig = three_bones();
  }
  /// Of 30 frames each.
  void offer(std::vector<uint64_t> seeds) {
    session.made_motions.offered.clear();
    for (const uint64_t seed : seeds) {
      auto made = std::make_shared<app::GeneratedMotion>();
      made->seed = seed, made->nearest_m = 0.012;
      made->motion.poses.assign(30, rest_pose(session.bones.rig->found.rig));
      app::MadeMotion one{{}, made};
      one.how.seed = seed;
      session.made_motions.offered.push_back(one);
    }
  }
  void keep(size_t k, const std::string& name) {
    const app::MadeMotion& one = session.made_motions.offered[k];
    session.document.bones.clips.push_back({name, one.how});
    session.made_motions.clips.push_back(one.made);
  }
};

TEST_F(MadeMotionsPanel, AsksForAsManyAsAreWanted) {
  panel("bones");
  expect_click("generate.make", {"generate.make 90 count 3 seed 1 engine match"});
  expect_typed("generate.frames", "40", {});
  expect_typed("generate.count", "5", {});
  expect_typed("generate.seed", "7", {});
  click("generate.loop");
  frame(2);
  expect_click("generate.make", {"generate.make 40 loop count 5 seed 7 engine match"});
}

TEST_F(MadeMotionsPanel, BetweenTwoFramesTakesTheMarksOfTheTimeline) {
  panel("bones");
  click("generate.between");
  frame(2);
  EXPECT_FALSE(shown("generate.loop")) << "a loop ends as it begins";
  EXPECT_FALSE(mark("generate.marks").enabled) << "nothing is marked";
  expect_click("generate.make", {"generate.make 90 between 0 47 count 3 seed 1 engine match"});
  expect_typed("generate.first", "5", {});
  expect_typed("generate.last", "30", {});
  expect_click("generate.make", {"generate.make 90 between 5 30 count 3 seed 1 engine match"});
  session.playback.in = 10, session.playback.out = 20;
  frame(2);
  expect_click("generate.marks", {});
  expect_click("generate.make", {"generate.make 90 between 10 20 count 3 seed 1 engine match"});
}

TEST_F(MadeMotionsPanel, TheButtonIsGreyWhereNothingCanBeMade) {
  auto still = std::make_shared<DiscoveredRig>(*three_bones());
  still->found.motion.poses.resize(1);
  session.bones.rig = still;
  panel("bones");
  EXPECT_FALSE(mark("generate.make").enabled) << "one pose is no motion";
  session.bones.rig = three_bones();
  frame(2);
  EXPECT_TRUE(mark("generate.make").enabled);
  click("generate.between");
  frame(2);
  expect_typed("generate.last", "200", {});
  frame(2);
  EXPECT_FALSE(mark("generate.make").enabled) << "there is no frame 200";
}

TEST_F(MadeMotionsPanel, TellsHowFarItIsAndIsCancelled) {
  session.made_motions.job = 7, session.made_motions.share = 0.2f;
  session.jobs = {{7, "Making motions", 0.2f, 30, true}};
  panel("bones");
  EXPECT_FALSE(shown("generate.make"));
  expect_click("generate.work.cancel", {"job.cancel 7"});
}

TEST_F(MadeMotionsPanel, AClickKeepsOneAndTheKeptOnesAreRenamedAndRemoved) {
  offer({4, 5});
  panel("bones");
  EXPECT_FALSE(shown("generate.clips.0"));
  expect_click("generate.offered.1", {"generate.keep 5"});
  keep(1, "motion 5");
  frame(2);
  EXPECT_FALSE(shown("generate.offered.1")) << "it is a clip already";
  EXPECT_FALSE(shown("generate.name"));
  expect_click("generate.clips.0", {});
  frame(2);
  expect_typed("generate.name", "trot", {"generate.rename 0 trot"});
  expect_click("generate.remove", {"generate.remove 0"});
  expect_click("generate.clear", {"generate.clear"});
  expect_click("generate.ghosts.1", {"view.made_motions over"});
}

}  // namespace
}  // namespace understudy::ui
