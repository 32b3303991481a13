// The panel of a source's own skeleton with mouse and keys: what is asked for, and what is told.
#include "tests/ui/support/panels_test.hpp"
#include "tests/ui/support/three_bones.hpp"
#include "ui/panels/files.hpp"
#include "ui/panels/timeline.hpp"

namespace understudy::ui {
namespace {

class BonesPanel : public PanelsTest {
 protected:
  BonesPanel() {
    input.size = {380, 1500};
    session.jobs.clear();
    session.working = false;
  }
  void show_found() {
    session.document.bones.wanted = true;
    session.bones.rig = three_bones();
    panel("bones");
  }
};

TEST_F(BonesPanel, AsksForAsManyAsMoveOrForSoManyAtMost) {
  panel("bones");
  expect_click("bones.find", {"bones.find auto"});
  click("bones.auto");
  frame(2);
  expect_typed("bones.most", "9", {});
  expect_click("bones.find", {"bones.find 9"});
}

TEST_F(BonesPanel, AsksForAKindsKeypoints) {
  panel("bones");
  click("bones.method.1");
  frame(2);
  EXPECT_FALSE(shown("bones.auto")) << "as many as move";
  expect_click("bones.find", {"bones.find slots person"});
  click("bones.body");
  frame(2);
  click("bones.body.2");
  frame(2);
  expect_click("bones.find", {"bones.find slots hand"});
  session.document.bones.search = {0, "slots", "arm"};
  frame(2);
  expect_click("bones.find", {"bones.find slots arm"});
  session.document.bones.search = {};  // undone
  frame(2);
  expect_click("bones.find", {"bones.find auto"});
}

TEST_F(BonesPanel, OffersMethodsWithoutWeightsOnlyWhereTheDocumentHasThem) {
  panel("bones");
  EXPECT_FALSE(shown("bones.method.2"));
  session.document.bones.search = {0, "paper", "person"};
  frame(2);
  if (!shown("bones.method.2")) click("bones.method");  // a list where three are too wide
  frame(2);
  EXPECT_TRUE(shown("bones.method.2"));
}

TEST_F(BonesPanel, WithoutASourceThereIsNothingToFind) {
  session.document.source.path.clear();
  panel("bones");
  EXPECT_FALSE(mark("bones.find").enabled);
}

TEST_F(BonesPanel, TellsItsStagesAndIsCancelled) {
  session.document.bones.wanted = true;
  session.bones.job = 12, session.bones.stage = "Surface", session.bones.share = 0.3f;
  session.jobs = {{12, "Finding bones", 0.3f, 40, true}};
  panel("bones");
  EXPECT_TRUE(shown("bones.stage.0") && shown("bones.stage.3"));
  EXPECT_FALSE(shown("bones.find"));
  expect_click("bones.work.cancel", {"job.cancel 12"});
  session.bones.job = 0, session.bones.stage.clear();
  frame(2);
  EXPECT_TRUE(shown("bones.find"));
}

TEST_F(BonesPanel, AClickOnARowChoosesTheBoneAndAnotherLetsItGo) {
  show_found();
  expect_click("bones.bone.1", {"bones.select 1"});
  EXPECT_FALSE(shown("bones.name")) << "none is chosen yet";
  session.bones.selected = 1;
  frame(2);
  expect_click("bones.bone.1", {"bones.select none"});
  EXPECT_TRUE(shown("bones.name"));
}

TEST_F(BonesPanel, EditsTheChosenBone) {
  show_found();
  session.bones.selected = 2;
  frame(2);
  expect_click("bones.merge", {"bones.merge 2"});
  expect_click("bones.split", {"bones.split 2"});
  expect_click("bones.root", {"bones.root 2"});
  expect_typed("bones.name", "hoof", {"bones.rename 2 hoof"});
  expect_typed("bones.y", "0.25", {"bones.move 2 0 0.25 0"});
  expect_click("bones.kind.1", {"bones.kind 2 hinge"});
  session.falloff = 7;
  EXPECT_FALSE(shown("bones.brush_radius")) << "nothing is painted";
  expect_click("bones.paint_tool", {"tool paint"});
  session.tool = app::Tool::Paint;
  frame(2);
  expect_click("bones.brush_mode.1", {"tool.brush_mode subtract"});
  expect_click("bones.paint_tool", {"tool look"});
  session.tool = app::Tool::Look;
  frame(2);
  expect_click("bones.turn_tool", {"tool bones"});
  expect_typed("bones.turn_z", "90", {"bones.turn 2 20 0 0 1.5708"});
  session.bones.selected = 0;
  frame(2);
  EXPECT_FALSE(mark("bones.merge").enabled) << "the root hangs on nothing";
}

TEST_F(BonesPanel, SmoothsTrimsAndFits) {
  show_found();
  click("bones.motion");
  frame(2);
  expect_click("bones.smooth", {"bones.smooth 0.5 all"});
  expect_click("bones.trim", {"bones.trim 5 30"});
  expect_click("bones.fit", {"bones.fit"});
}

TEST_F(BonesPanel, PaintsTheSurfaceAndExports) {
  show_found();
  expect_click("bones.surface.1", {"view.bone_surface over"});
  expect_click("bones.export", {"dialog.open export_bones"});
  EXPECT_TRUE(purpose_of("export_bones").has_value());
  expect_click("bones.drop", {"bones.drop"});
}

TEST_F(BonesPanel, TellsWhoIsNearWhomAndGivesNames) {
  show_found();
  EXPECT_FALSE(shown("bones.name_as_joints")) << "the source is no person";
  session.bones.near = {
      {Pelvis, 0.02f, 0.01f, true}, {LeftKnee, 0.03f, 0.02f, true}, {Head, 0.9f, 0.5f, false}};
  session.bones.steady.assign(kJointCount, {0, 0.5, 0.02f});
  session.bones.steady[1] = {2, 1, 0.03f};
  frame(2);
  expect_click("bones.near.1", {"bones.select 2"});
  expect_click("bones.name_as_joints", {"bones.name_as_joints"});
}

TEST_F(BonesPanel, TheTimelineShowsHowFarTheyAreOffAndWhereNotToTrustThem) {
  show_found();
  session.view.metric = "bones_off";
  TimelineState state;
  state.follow(session);
  ASSERT_EQ(state.bones_off_mm.size(), 48u);
  EXPECT_NEAR(state.bones_off_mm[30], 30, 1e-3f);
  ASSERT_EQ(state.doubted.size(), 1u);
  EXPECT_EQ(state.doubted[0].first, 30);
  EXPECT_EQ(state.why(30), "") << "the person that is seen there is good";
  session.source.no_person = true;
  session.bones.rig = three_bones();
  state.follow(session);
  EXPECT_EQ(state.bad_numbers, std::vector<int>{30});
  EXPECT_NE(state.why(30), "");
  input.size = {1100, 200};
  panel("timeline");
  EXPECT_TRUE(shown("timeline.track"));
}

}  // namespace
}  // namespace understudy::ui
