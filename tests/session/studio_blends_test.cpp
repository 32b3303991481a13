// Blends of motions as a document's source: made anew from their recipe, undone, saved and opened again.
#include <algorithm>

#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"
#include "tests/app/sample_files.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

class StudioBlends : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    tests::WalkOptions fast;
    fast.fps = 48;
    tests::write_walk(path("walk.npz"));
    tests::write_walk(path("run.npz"), fast);
  }
  void open_blend(Studio& studio, const Arguments& more = {}) {
    Arguments words = {path("walk.npz"), path("run.npz")};
    words.insert(words.end(), more.begin(), more.end());
    studio.run("source.blend", words);
    if (studio.session().document.takes.empty()) studio.run("open", {path("target.obj")});
    studio.wait_idle();
  }
  static const Motion& shown(const Studio& studio) { return studio.session().takes.at(0).shown; }
  static std::vector<float> weights(const Studio& studio) {
    std::vector<float> all;
    for (const BlendPart& part : studio.session().document.source.blend->parts) all.push_back(part.weight);
    return all;
  }
};

TEST_F(StudioBlends, ArePerformedAndSayOfEachFrameThatItWasMade) {
  Studio studio(services());
  open_blend(studio);
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_EQ(studio.session().source.name, "walk - run");
  EXPECT_GT(shown(studio).poses.size(), 10u);
  ASSERT_EQ(shown(studio).doubt_m.size(), shown(studio).poses.size());
  for (const float doubt : shown(studio).doubt_m) EXPECT_GT(doubt, 0);
  EXPECT_TRUE(studio.session().settings.recent_sources.empty()) << "no file alone gives it again";
  studio.run("edit.fill", {"0", "4", "6"});
  studio.wait_idle();
  for (const float doubt : shown(studio).doubt_m)
    EXPECT_GT(doubt, 0) << "what is not filled is blended still";
}

TEST_F(StudioBlends, AWeightIsDraggedLiveAndUndoneInOneStep) {
  Studio studio(services());
  open_blend(studio, {"1,1"});
  const Motion half = shown(studio);
  for (const char* share : {"0.6", "0.8", "1"}) {
    studio.run("source.blend_weight", {"1", share});
    studio.tick(0.01);
  }
  studio.wait_idle();
  EXPECT_EQ(weights(studio), (std::vector<float>{0, 1}));
  EXPECT_LT(shown(studio).poses.size(), half.poses.size()) << "the run is shorter";
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(weights(studio), (std::vector<float>{0.5f, 0.5f}));
  EXPECT_TRUE(same_poses(shown(studio), half));
  studio.run("source.blend_cycles", {"2"});
  studio.wait_idle();
  EXPECT_GT(shown(studio).poses.size(), 2 * half.poses.size() - 3);
}

TEST_F(StudioBlends, AreTheSameInADocumentThatWasSaved) {
  Studio studio(services());
  open_blend(studio, {"0.3,0.7"});
  studio.run("document.save_as", {path("blend.understudy")});
  Studio again(services());
  again.run("document.open", {path("blend.understudy")});
  again.wait_idle();
  EXPECT_EQ(weights(again), weights(studio));
  EXPECT_TRUE(same_poses(shown(again), shown(studio)));
  EXPECT_EQ(shown(again).doubt_m, shown(studio).doubt_m);
  EXPECT_FALSE(again.session().changed);
}

TEST_F(StudioBlends, AskForAFileThatIsGone) {
  Studio studio(services());
  open_blend(studio);
  studio.run("document.save_as", {path("blend.understudy")});
  fs::rename(path("run.npz"), path("elsewhere.npz"));
  Studio again(services());
  again.run("document.open", {path("blend.understudy")});
  ASSERT_TRUE(again.session().question);
  EXPECT_EQ(again.session().question->missing, std::vector<std::string>{path("run.npz")});
  again.run("document.relocate", {path("run.npz"), path("elsewhere.npz")});
  again.wait_idle();
  EXPECT_FALSE(again.session().question);
  EXPECT_TRUE(same_poses(shown(again), shown(studio)));
}

TEST_F(StudioBlends, OfAFileThatHasChangedSaySo) {
  Studio studio(services());
  open_blend(studio);
  studio.run("document.save_as", {path("blend.understudy")});
  tests::WalkOptions other;
  other.fps = 55;
  tests::write_walk(path("run.npz"), other);
  Studio again(services());
  again.run("document.open", {path("blend.understudy")});
  again.wait_idle();
  const std::string sentence =
      path("run.npz") + ": has changed since it was blended, so the blend is another";
  EXPECT_NE(again.session().source.decision.find(sentence), std::string::npos);
}

TEST_F(StudioBlends, TakeTheFramesBetweenTheMarksOfWhatIsOpen) {
  Studio studio(services());
  studio.run("open", {path("target.obj")});
  studio.run("source.open", {path("walk.npz")});
  studio.wait_idle();
  studio.run("playback.in", {"20"});
  studio.run("playback.out", {"50"});
  studio.run("source.blend_with", {path("run.npz")});
  studio.wait_idle();
  const BlendRecipe& blend = *studio.session().document.source.blend;
  ASSERT_EQ(blend.parts.size(), 2u);
  EXPECT_EQ(in_words(blend.parts[0]), path("walk.npz") + "@20:50");
  EXPECT_FALSE(blend.parts[1].range);
  studio.run("source.blend_with", {path("walk.npz")});
  studio.run("source.blend_with", {path("walk.npz")});
  EXPECT_EQ(weights(studio), (std::vector<float>{0.25f, 0.25f, 0.25f, 0.25f}));
  EXPECT_THROW(studio.run("source.blend_with", {path("walk.npz")}), Error) << "four are the most";
}

TEST_F(StudioBlends, BecomeMotionsOfAStudyStepByStep) {
  Studio studio(services());
  EXPECT_THROW(studio.run("study.add_blends", {"7"}), Error) << "no study";
  open_blend(studio);
  studio.run("study.new", {"takes"});
  const Study& study = *studio.session().study.study;
  ASSERT_EQ(study.motions.size(), 1u);
  EXPECT_EQ(study.motions[0].name, "walk - run");
  studio.run("study.add_blends", {"3"});
  ASSERT_EQ(study.motions.size(), 4u);
  EXPECT_EQ(study.motions[2].name, "walk - run 0.50 0.50");
  EXPECT_EQ(study.motions[3].source.blend->parts[1].weight, 1);
  EXPECT_THROW(studio.run("study.add_blends", {"1"}), Error);
  open_both(studio);
  EXPECT_THROW(studio.run("study.add_blends", {"3"}), Error) << "no blend is open";
}

TEST_F(StudioBlends, ThatCannotBeAreRefusedAndChangeNothing) {
  Studio studio(services());
  EXPECT_THROW(studio.run("source.blend_with", {path("walk.npz")}), Error) << "nothing is open";
  open_both(studio);
  const Document before = studio.session().document;
  for (const Arguments& bad : std::vector<Arguments>{{},
                                                     {path("walk.npz")},
                                                     {path("walk.npz"), "1,1"},
                                                     {path("walk.npz"), path("gone.npz")},
                                                     {path("walk.npz"), path("run.npz"), "1,1,1"},
                                                     {path("walk.npz"), path("run.npz"), "0,0"},
                                                     {path("walk.npz"), path("run.npz") + "@9:3"},
                                                     {path("walk.npz"), path("target.obj")}})
    EXPECT_THROW(studio.run("source.blend", bad), Error);
  EXPECT_THROW(studio.run("source.blend_with", {path("walk.npz")}), Error) << "scans are open";
  EXPECT_THROW(studio.run("source.blend_weight", {"0", "0.5"}), Error) << "there is no blend";
  EXPECT_TRUE(same(studio.session().document, before));
  open_blend(studio);
  for (const Arguments& bad :
       std::vector<Arguments>{{"2", "0.5"}, {"-1", "0.5"}, {"0", "1.5"}, {"0"}, {"0", "nan"}})
    EXPECT_THROW(studio.run("source.blend_weight", bad), Error);
  EXPECT_THROW(studio.run("source.blend_cycles", {"0"}), Error);
}

TEST_F(StudioBlends, ThatCannotBeReadLeaveWhatWasOpen) {
  Studio studio(services());
  open_both(studio);
  const Document before = studio.session().document;
  tests::WalkOptions still;
  still.motion = "still";
  tests::write_walk(path("still.npz"), still);
  studio.run("source.blend", {path("walk.npz"), path("still.npz")});
  studio.wait_idle();
  EXPECT_TRUE(same(studio.session().document, before));
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_NE(studio.session().errors[0].text.find("nobody steps in it"), std::string::npos)
      << studio.session().errors[0].text;
}

}  // namespace
}  // namespace understudy::app
