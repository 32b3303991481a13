// Inspector, layers and metrics: what each control asks for.
#include <algorithm>

#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/metrics.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;

class Inspector : public PanelsTest {
 protected:
  Inspector() { panel("inspector"); }
};

TEST_F(Inspector, ButtonsAskForTheirCommands) {
  expect_click("source.open", {"dialog.open open_source"});
  expect_click("take.add", {"dialog.open open_target"});
  expect_click("take.replace", {"dialog.open replace_target"});
  expect_click("take.remove", {"target.remove 0"});
  expect_click("take.1", {"target.select 1"});
  expect_click("method.compare", {"dialog.open compare"});
  expect_click("work.pause", {"work.pause"});
  expect_click("work.restart", {"work.restart"});
  session.paused = true;
  frame(2);
  expect_click("work.resume", {"work.resume"});
}

TEST_F(Inspector, ImportSettingsAreAskedForWhenWrittenOrChosen) {
  expect_typed("source.fps", "25", {"source.fps 25"});
  expect_typed("source.fps", "auto", {});  // it was automatic
  EXPECT_FALSE(shown("source.units")) << "folded away where nothing is told";
  click("inspector.import");
  expect_typed("source.turn", "90", {"source.turn 90"});
  expect_typed("source.floor", "0.05 m", {"source.floor 0.05"});
  expect_choice("source.units", 3, {"source.units mm"});
  expect_choice("source.up", 6, {"source.up -z"});
  expect_click("source.extractor.1", {"source.extractor paper"});
  expect_choice("target.units", 2, {"target.units 0 cm"});
  expect_choice("target.up", 3, {"target.up 0 z"});
  EXPECT_FALSE(shown("target.height.reset"));
  expect_typed("target.height", "1.2 m", {"target.height 0 1.2"});
  expect_typed("target.height", "tall", {});
  expect_typed("source.height", "1.8", {"source.height 1.8"});
  session.document.takes[0].target.import.height = 1.2f;
  frame(2);
  expect_typed("target.height", "auto", {"target.height 0 auto"});
  expect_click("target.height.reset", {"target.height 0 auto"});
  expect_typed("target.turn", "-45", {"target.turn 0 -45"});
  expect_typed("target.turn", "north", {});
  session.document.takes[0].target.forward = false;
  expect_typed("target.turn", "auto", {"target.turn 0 auto"});
  expect_typed("target.betas", "1.2,-0.5", {"target.betas 0 1.2,-0.5"});
  expect_typed("take.name", "the adult", {"take.rename 0 \"the adult\""});
}

TEST_F(Inspector, TheTableOfTimesIsChosenAndPutAway) {
  EXPECT_FALSE(shown("source.times")) << "folded away where nobody asked for it";
  click("inspector.times");
  EXPECT_FALSE(shown("source.times.reset"));
  const float off = mark("source.times").rect.width();
  expect_click("source.times.browse", {"dialog.open source_times"});
  session.document.source.times = "/data/my times.csv";
  frame(3);
  EXPECT_GT(mark("source.times").rect.width(), off) << "the file's name";
  hover("source.times");
  EXPECT_TRUE(shown("tooltip")) << "the whole path";
  expect_click("source.times.browse", {"dialog.open source_times"});
  expect_click("source.times.reset", {"source.times off"});
}

TEST_F(Inspector, ScansAreCompletedToARateAndMayHaveMarkers) {
  click("inspector.times");
  EXPECT_FALSE(shown("source.markers"));
  expect_click("source.complete.2", {"source.complete 60"});
  session.document.source.complete = 60;
  frame(3);
  expect_click("source.complete.0", {"source.complete off"});
  expect_click("source.markers.browse", {"dialog.open source_markers"});
  session.document.source.markers = "/data/markers.csv";
  frame(3);
  expect_click("source.markers.reset", {"source.markers off"});
}

TEST_F(Inspector, TheTableOfTimesIsPutAwayWithTheKeys) {
  click("inspector.times");
  session.document.source.times = "/data/times.csv";
  frame(3);
  for (int i = 0; i < 80 && gui.ui().focus().name() != "source.times.reset"; ++i) key(render::Key::Tab);
  ASSERT_EQ(gui.ui().focus().name(), "source.times.reset");
  queue.clear();
  key(render::Key::Enter);
  EXPECT_EQ(asked(), Lines{"source.times off"});
}

TEST_F(Inspector, WhatIsNoScanHasNoTimes) {
  click("inspector.times");
  EXPECT_TRUE(shown("source.times"));
  session.source.clips = {{"walk", 2}};
  frame(3);
  EXPECT_FALSE(shown("source.times"));
  EXPECT_FALSE(shown("source.complete"));
  session.source.clips.clear();
  session.document.source.motion = "/data/walk.npz";
  frame(3);
  EXPECT_FALSE(shown("source.times"));
}

TEST_F(Inspector, ABlendHasAShareForEachOfItsMotions) {
  EXPECT_FALSE(shown("source.blend_with")) << "scans are not blended";
  session.source.clips = {{"walk", 2}};
  frame(3);
  expect_click("source.blend_with", {"dialog.open blend_with"});
  session.document.source.blend =
      app::BlendRecipe{{{"/a/walk.bvh", app::BlendRange{3, 40}, 0.5f}, {"/a/run.npz", {}, 0.5f}}};
  session.source.clips.clear();
  frame(3);
  EXPECT_FALSE(shown("inspector.import")) << "its files say that themselves";
  expect_drag("source.blend.0", "source.blend_weight 0 ");
  expect_drag("source.blend.1", "source.blend_weight 1 ");
  expect_typed("source.blend_cycles", "3", {"source.blend_cycles 3"});
  expect_click("source.blend_with", {"dialog.open blend_with"});
  session.document.source.blend->parts.resize(4);
  frame(3);
  EXPECT_FALSE(mark("source.blend_with").enabled) << "four are the most";
}

TEST_F(Inspector, PeopleAreListedAndAClickChoosesOne) {
  session.source.people = {{1, true, 48}};
  session.source.person = 1;
  frame(2);
  EXPECT_FALSE(shown("source.people.0")) << "a person alone is no list";
  session.source.people.push_back({3, false, 1});
  frame(2);
  EXPECT_FALSE(shown("source.people.2"));
  expect_click("source.people.1", {"source.person 3"});
  expect_choice("source.person", 1, {"source.person largest"});
  expect_choice("source.person", 2, {"source.person 1"});
  session.document.source.person = "3";
  frame(2);
  expect_click("source.people.1", {});
  expect_click("source.people.0", {"source.person 1"});
}

TEST_F(Inspector, TheTargetsProportionsAreDraggedAndReset) {
  const std::pair<const char*, float app::Method::*> numbers[] = {
      {"target.stride", &app::Method::stride},
      {"target.hip_height", &app::Method::hip_height},
      {"target.arm_reach", &app::Method::arm_reach}};
  for (const auto& [name, value] : numbers) {
    const std::string number = name;
    EXPECT_FALSE(shown(number + ".reset"));
    expect_drag(name, number + " 0 ");
    session.document.takes[0].method.*value = 0.5f;
    frame(2);
    expect_click(number + ".reset", {number + " 0 " + argument(app::Method().*value)});
  }
}

TEST_F(Inspector, TheRestPoseIsEditedInTheViewUntilDone) {
  EXPECT_FALSE(mark("edit.rest_pose_clear").enabled);
  expect_click("target.rest_pose", {"tool rest-pose"});
  session.tool = app::Tool::RestPose;
  session.document.takes[0].target_edits.rest_pose = {{LeftShoulder, Vec3(0, 0, -0.5f)}};
  frame(3);
  expect_click("target.rest_mirror", {"tool.mirror off"});
  expect_click("edit.rest_pose_clear", {"edit.rest_pose_clear 0"});
  expect_click("target.rest_pose", {"tool look"});
}

TEST_F(Inspector, AFileThatMayMoveHasAnimationsToChoose) {
  session.document.source.path = "/scans/walk.FBX";
  frame(2);
  expect_typed("source.clip", "2", {"source.clip 2"});
  expect_click("source.as_scan", {"source.as_scan on"});
}

TEST_F(Inspector, AnimationsOfAFileAreListedAndChosenByAClick) {
  session.document.source.path = "/clips/moves.glb";
  session.source.clips = {{"idle", 1.5}, {"walk", 12.25}, {"walk", 3}, {"2", 1}};
  session.source.clip = 1;
  frame(3);
  EXPECT_FALSE(shown("source.clip"));
  expect_click("source.clips.0", {"source.clip idle"});
  expect_click("source.clips.1", {});  // it is the one
  expect_click("source.clips.2", {"source.clip 3"});
  expect_click("source.clips.3", {"source.clip 4"});
  session.source.clips.resize(1);
  frame(3);
  EXPECT_FALSE(shown("source.clips.0"));
}

TEST_F(Inspector, SaysWhereTheShapeBinds) {
  EXPECT_FALSE(shown("target.binding"));  // it uses its own skin weights
  auto binding = std::make_shared<SafeBinding>();
  session.takes[0].binding = binding;
  frame(3);
  const float one_line = mark("target.binding").rect.height();
  binding->note = "12 % of the surface is bound by its shape alone: head, left arm, left hand, right hand";
  frame(3);
  EXPECT_GT(mark("target.binding").rect.height(), 1.5f * one_line);  // wrapped, not cut
}

TEST_F(Inspector, WhatIsLeftWithoutEnterIsAskedForToo) {
  click("inspector.import");
  write_into("source.turn", "15");
  EXPECT_EQ(asked(), Lines());
  click("source.fps");
  EXPECT_EQ(asked(), Lines{"source.turn 15"});
}

TEST_F(Inspector, EscapeAndNonsenseAskForNothing) {
  click("inspector.import");
  write_into("source.turn", "15");
  key(render::Key::Escape);
  EXPECT_EQ(asked(), Lines());
  expect_typed("source.turn", "north", {});
}

TEST_F(Inspector, TheCurrentTakeIsNamedWhereItIsActedOn) {
  EXPECT_EQ(take_title(session, "Result"), "Result: adult");
  const float adult = mark("take.remove").rect.width();
  app::choose_pane(session, 2);
  EXPECT_EQ(take_title(session, "Result"), "Result: child");
  frame(2);
  EXPECT_EQ(mark("take.remove").rect.width(), adult);  // over the whole width, whatever the name
  expect_click("take.remove", {"target.remove 1"});
  session.document.takes[1].name = std::string(200, 'x');
  frame(2);
  expect_click("take.remove", {"target.remove 1"});
}

TEST_F(Inspector, MethodSwitchesNameTheSelectedTake) {
  session.selected_take = 1;
  frame(2);
  expect_click("method.engine.0", {"method.engine 1 copy"});
  expect_click("method.extractor.1", {"method.extractor 1 paper"});
  expect_click("method.offsets", {"method.offsets 1 off"});
  expect_click("method.path.2", {"method.path 1 in-place"});
  expect_click("method.repair_swaps", {"method.filter 1 repair_swaps off"});
  expect_click("method.smooth_joints", {"method.filter 1 smooth_joints off"});
  expect_click("method.fix_lengths", {"method.filter 1 fix_lengths off"});
}

TEST_F(Inspector, AnEngineThatIsNotThereIsNotShownAsAnother) {
  session.document.takes[0].method.engine = "hybrid";
  frame(2);
  // A choice that is made already would ask for nothing.
  expect_click("method.engine.0", {"method.engine 0 copy"});
}

TEST_F(Inspector, WithNothingOpenOnlyOpeningIsOffered) {
  session = app::Session();
  frame(2);
  EXPECT_TRUE(shown("source.open"));
  EXPECT_FALSE(shown("source.fps"));
  EXPECT_FALSE(shown("method.engine"));
  EXPECT_FALSE(mark("take.remove").enabled);
}

TEST_F(PanelsTest, WordsThatANewcomerCannotKnowAreExplainedWithAUnit) {
  const auto told = [&](const char* name) {
    return gui.ui().explanation_at(mark(name).visible.at(0.5f, 0.5f)).value_or(Explanation()).text;
  };
  const auto contains = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  panel("inspector");
  EXPECT_TRUE(contains(told("method.engine.0"), "Copy: turns each bone"));
  EXPECT_TRUE(contains(told("method.engine.1"), "Paper: a recurrent network"));
  EXPECT_TRUE(contains(told("method.extractor.0"), "Dense: every point"));
  EXPECT_TRUE(contains(told("method.offsets"), "millimetres"));
  EXPECT_TRUE(contains(told("method.path.0"), "metres"));
  panel("edit");
  session.document.takes[0].pose_edits = PoseEdits{};  // a number with a reset button explains that
  frame(2);
  EXPECT_TRUE(contains(told("edit.smooth"), "0.2 s"));
  EXPECT_TRUE(contains(told("edit.raise"), "metres"));
}

class LayersPanel : public PanelsTest {
 protected:
  LayersPanel() { panel("layers"); }
};

TEST_F(LayersPanel, EverySwitchOfBothPanesAsksForItsLayer) {
  const app::Layers& layers = session.view.source;
  const std::pair<const char*, bool> rows[] = {
      {"surface", layers.surface},         {"skeleton", layers.skeleton},  {"x_ray", layers.x_ray},
      {"joint_names", layers.joint_names}, {"ground", layers.ground},      {"trails", layers.trails},
      {"ghosts", layers.ghosts},           {"wireframe", layers.wireframe}};
  for (const std::string pane : {"source", "take"})
    for (const auto& [name, on] : rows)
      expect_click("layers." + pane + "." + name,
                   {"view.layer " + pane + " " + name + (on ? " off" : " on")});
  expect_click("layers.source.as_points", {"view.layer source as_points on"});
  session.source.has_faces = false;
  frame(2);
  EXPECT_FALSE(shown("layers.source.as_points"));
  EXPECT_FALSE(shown("layers.source.wireframe")) << "points have no edges";
  EXPECT_TRUE(shown("layers.take.wireframe"));
}

TEST_F(LayersPanel, TheOverlaysOpacitiesAndSpreadAreThereInThatLayout) {
  EXPECT_FALSE(shown("layers.spread"));
  session.view.layout = app::Layout::Overlay;
  session.view.overlay = {0.5f, 0.5f, 0.5f, 0};
  frame(2);
  for (const std::string layer : {"scan", "skeletons", "results"})
    expect_drag("layers.opacity." + layer, "view.opacity " + layer + " ");
  expect_drag("layers.spread", "view.spread ");
  session.view.overlay.results = 0.3f;
  frame(2);
  expect_click("layers.opacity.results.reset", {"view.opacity results 0.62"});
}

TEST_F(LayersPanel, LightAndBackground) {
  click("layers.light_and_background");
  frame(2);
  for (const std::string what : {"turn", "height", "brightness"})
    expect_drag("layers.light." + what, "view.light " + what + " ");
  expect_choice("layers.background", 1, {"view.background white"});
  EXPECT_FALSE(shown("layers.background_colour"));
  session.view.background = app::Background::Custom;
  frame(2);
  EXPECT_TRUE(shown("layers.background_colour"));
}

TEST_F(LayersPanel, ColoursTrailsAndScales) {
  expect_choice("layers.source.colour", 1, {"view.colour source confidence"});
  expect_choice("layers.take.colour", 2, {"view.colour take uncertainty"});
  expect_choice("layers.take.colour", 4, {"view.colour take error"});
  expect_choice("layers.weights_joint", 1, {"view.weights_joint pelvis"});
  expect_choice("layers.trail_joint", 5, {"view.trail_joint right_knee on"});
  expect_click("layers.trail.left_wrist", {"view.trail_joint left_wrist off"});
  expect_drag("layers.ghost_count", "view.ghosts ");
  expect_drag("layers.ghost_step", "view.ghosts 3 ");
  expect_click("layers.ghosts_by_time", {"view.ghosts_by_time on"});
  expect_drag("layers.error_scale", "view.error_scale ");
}

TEST_F(LayersPanel, Cameras) {
  for (const app::ViewPreset& preset : app::kViewPresets)
    expect_click(std::string("layers.preset.") + preset.name, {std::string("view.preset ") + preset.name});
  expect_click("layers.fit", {"view.fit"});
  expect_click("layers.ortho", {"view.ortho on"});
  session.view.linked = false, session.view.active_pane = 1;
  session.view.cameras.resize(2), session.view.cameras[1].orthographic = true;
  expect_click("layers.ortho", {"view.ortho off"});  // of the active view
  session.view.linked = true;
  expect_click("layers.linked", {"view.link off"});
  expect_click("layers.follow", {"view.follow off"});
  expect_drag("layers.turntable", "view.turntable ");
}

class MetricsPanel : public PanelsTest {
 protected:
  MetricsPanel() { panel("metrics"); }
  MetricsState& state = panel_state<MetricsState>(context);
};

TEST_F(MetricsPanel, AClickInACurveGoesToItsFrame) {
  queue.clear();
  click(mark("metrics.plot.foot_skate").visible.at(0.5f, 0.5f));
  const Lines lines = asked();
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.front().rfind("playback.frame ", 0), 0u);
  const int frame_asked = std::stoi(lines.front().substr(15));
  EXPECT_GT(frame_asked, 10);
  EXPECT_LT(frame_asked, 40);
}

TEST_F(MetricsPanel, ACurveCanBePutIntoTheTimelineAndTheTableExported) {
  expect_click("metrics.in_timeline.foot_skate", {"view.metric foot_skate"});
  expect_click("metrics.csv", {"dialog.open csv"});
}

TEST_F(MetricsPanel, TheHistogramShowsTheStageChosen) {
  const float whole = state.durations.back();
  click("metrics.stage");
  frame(2);
  click("metrics.stage.0");
  EXPECT_EQ(state.stage, 0);
  EXPECT_EQ(state.durations.size(), 256u);
  EXPECT_LT(state.durations.back(), whole);
  EXPECT_NEAR(state.durations[128], 2.1, 0.1);
}

TEST_F(MetricsPanel, NamesKeepTheirRoomHoweverManyTakesThereAre) {
  for (int k = 0; k < 6; ++k) {
    session.document.takes.push_back(session.document.takes[0]);
    session.takes.push_back(session.takes[0]);
  }
  session.takes[0].metrics = {{"arm_buried_added", 0.01}};
  frame(3);
  EXPECT_LT(mark("metrics.figures.0.text").rect.height(), 4.5f * ImGui::GetTextLineHeight());
  EXPECT_FALSE(shown("metrics.figures.title.7"));
}

TEST_F(MetricsPanel, NamesAreWholeAndPlainAndWhatNeedsTruthIsNamed) {
  session.takes[0].metrics = {{"arm_buried_added", 0.01}, {"new_in_2_0", 3}};
  frame(2);
  EXPECT_GT(mark("metrics.figures.0.text").rect.height(),
            1.8f * mark("metrics.figures.1.text").rect.height());
  EXPECT_TRUE(shown("metrics.needs_truth"));
  session.truth = std::make_shared<app::Truth>();
  frame();
  EXPECT_FALSE(shown("metrics.needs_truth"));
}

TEST_F(MetricsPanel, WithoutTakesItSaysSo) {
  session.takes.clear(), session.document.takes.clear();
  frame(2);
  EXPECT_FALSE(shown("metrics.plot.confidence"));
  EXPECT_FALSE(mark("metrics.csv").enabled);
}

}  // namespace
}  // namespace understudy::ui
