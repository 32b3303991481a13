// Timeline, log, start screen and status line.
#include <algorithm>
#include <map>

#include "retarget/base/text.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/bars.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/rows.hpp"
#include "ui/panels/timeline.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;

class Timeline : public PanelsTest {
 protected:
  Timeline() {
    input.size = {1280, 140};
    panel("timeline");
  }
  /// What dragging asks for besides frames to show. `share`: of the mark's width, where it is gripped.
  Lines dragged(const std::string& name, float share, float by) {
    queue.clear();
    const Rect rect = mark("timeline.track." + name).rect;
    const ImVec2 from(rect.min.x + std::clamp(share * rect.width(), 1.f, rect.width() - 1),
                      rect.at(0, 0.5f).y);
    drag(from, {from.x + by, from.y});
    return besides_frames();
  }
  Lines besides_frames() {
    Lines lines = asked();
    const auto shows = [](const std::string& line) { return starts_with(line, "playback.frame "); };
    lines.erase(std::remove_if(lines.begin(), lines.end(), shows), lines.end());
    return lines;
  }
  float frames_wide(int frames) {
    return mark("timeline.track").rect.width() * static_cast<float>(frames) / 59;
  }
  TimelineState& state = panel_state<TimelineState>(context);
};

TEST_F(Timeline, TransportAsksForItsCommands) {
  expect_click("timeline.first", {"playback.first"});
  expect_click("timeline.back", {"playback.step_back"});
  expect_click("timeline.play", {"playback.toggle"});
  expect_click("timeline.forward", {"playback.step_on"});
  expect_click("timeline.last", {"playback.last"});
  expect_click("timeline.loop", {"playback.loop off"});
  expect_click("timeline.in", {"playback.in"});
  expect_click("timeline.out", {"playback.out"});
  expect_click("timeline.clear_marks", {"playback.clear_marks"});
  expect_click("timeline.live", {"playback.follow_live"});
  expect_choice("timeline.rate", 1, {"playback.rate 0.25"});
  expect_choice("timeline.metric", 1, {"view.metric foot_skate"});
}

TEST_F(Timeline, FrameAndTimeCanBeWritten) {
  expect_typed("timeline.frame", "17", {"playback.frame 17"});
  expect_typed("timeline.time", "1:02.5", {"playback.seek 62.5"});
  expect_typed("timeline.time", "0.5", {"playback.seek 0.5"});
  expect_typed("timeline.time", "soon", {});
}

TEST_F(Timeline, AClickInTheTrackGoesThere) {
  queue.clear();
  click(mark("timeline.track").rect.at(0.25f, 0.6f));
  const Lines lines = asked();
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.front(), "playback.frame 15");
}

TEST_F(Timeline, StepsAreLettersThatLoopMarksSnapTo) {
  app::TakeState& take = session.takes[0];
  const Motion walk = builtin_motion("walk", human_rest());
  for (size_t t = 0; t < take.shown.poses.size(); ++t) take.shown.poses[t] = walk.poses[t];
  session.working = false;
  std::fill(take.shown.flags.begin(), take.shown.flags.end(), uint8_t{0});  // a flagged frame is in no step
  ++take.generation;
  frame(2);
  ASSERT_FALSE(state.steps.letters.empty());
  const int begins = state.steps.letters[0].frame;
  EXPECT_TRUE(state.steps.letters[0].letter == "L" || state.steps.letters[0].letter == "R");
  EXPECT_TRUE(shown("timeline.track.letter.0"));
  queue.clear();
  const Mark grip = mark("timeline.track.loop_first"), letter = mark("timeline.track.letter.0");
  drag(grip.rect.at(0.5f, 0.5f), {letter.rect.min.x + 4, grip.rect.at(0, 0.5f).y});
  const Lines lines = asked();
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "playback.in " + std::to_string(begins));
  expect_click("timeline.steps", {"view.steps off"});
  session.view.steps = false;
  frame(2);
  EXPECT_FALSE(shown("timeline.track.letter.0"));
}

TEST_F(Timeline, FramesBeyondTheLastCapturedOneAreAVioletBar) {
  app::TakeState& take = session.takes[0];
  for (const Pose& pose : take.shown.poses) take.performed.push_back({pose});
  const int count = static_cast<int>(take.performed.size());
  take.shown.poses.resize(static_cast<size_t>(count) + 10);
  take.shown.doubt_m.assign(take.shown.poses.size(), 0.f);
  for (int t = count; t < count + 10; ++t) take.shown.doubt_m[static_cast<size_t>(t)] = 0.05f;
  session.document.takes[0].pose_edits.go_on = GoOnEdit{10 / 30.0f};
  frame(2);
  const auto marks = edit_marks(session, {});
  const auto made = std::find_if(marks.begin(), marks.end(),
                                 [](const EditMark& edit) { return edit.mark.name == "made.on"; });
  ASSERT_NE(made, marks.end());
  EXPECT_EQ(made->mark.first, count);
  EXPECT_EQ(made->mark.last, count + 9);
  EXPECT_EQ(made->mark.words.substr(0, 7), "Goes on");
  EXPECT_EQ(made->remove, "edit.remove go_on 0");
  EXPECT_TRUE(shown("timeline.track.made.on"));
}

TEST_F(Timeline, ALoopsSeamIsShownAtBothItsEnds) {
  app::TakeState& take = session.takes[0];
  take.shown.fps = 30;
  take.shown.doubt_m.assign(take.shown.poses.size(), 0.f);
  session.document.takes[0].pose_edits.loop = LoopEdit{4, 40};
  std::map<std::string, LoopRange> bars;
  for (const EditMark& edit : edit_marks(session, {}))
    if (starts_with(edit.mark.name, "made.loop")) bars[edit.mark.name] = {edit.mark.first, edit.mark.last};
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_EQ(bars["made.loop_start"].first, 4);
  EXPECT_EQ(bars["made.loop_start"].last, 9);
  EXPECT_EQ(bars["made.loop_end"].first, 34);
  EXPECT_EQ(bars["made.loop_end"].last, 40);
}

TEST_F(Timeline, LoopMarksAreDragged) {
  queue.clear();
  const Mark first = mark("timeline.track.loop_first"), track = mark("timeline.track");
  drag(first.rect.at(0.5f, 0.5f), {track.rect.at(0.2f, 0).x, first.rect.at(0, 0.5f).y});
  const Lines lines = asked();
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "playback.in 12");
}

TEST_F(Timeline, TrimmedEndsAreGreyedUntilTheyAreBack) {
  const Rect track = mark("timeline.track").rect;
  EXPECT_NEAR(mark("timeline.track.trimmed.before").rect.max.x, track.at(1.5f / 59, 0).x, 1);
  EXPECT_NEAR(mark("timeline.track.trimmed.after").rect.min.x, track.at(40.5f / 59, 0).x, 1);
  session.document.takes[0].pose_edits.trim.reset();
  frame();
  EXPECT_FALSE(shown("timeline.track.trimmed.before"));
  EXPECT_FALSE(shown("timeline.track.trimmed.after"));
}

TEST_F(Timeline, AClickAtAnEditGoesThere) {
  expect_click("timeline.track.drags.4", {"playback.frame 4"});
  expect_click("timeline.track.swap.1", {"playback.frame 10"});
  expect_click("timeline.track.rotations.12", {"playback.frame 12"});
  session.playback.frame = 0;
  expect_click("timeline.track.fill.20", {"playback.frame 20"});
}

TEST_F(Timeline, ADraggedEditIsMovedOnceWhereItIsLetGo) {
  session.document.takes[0].pose_edits.skip = {22, 23, 24};
  frame();
  const float ten = frames_wide(10);
  const auto moved = [&](const std::string& name, float by) { return dragged(name, 0.5f, by); };
  EXPECT_EQ(moved("drags.4", ten), Lines{"edit.move drags 4 14"});
  EXPECT_EQ(moved("swap.1", ten), Lines{"edit.move swap 1 20"});
  EXPECT_EQ(moved("rotations.12", -ten), Lines{"edit.move rotations 0 12 2"});
  EXPECT_EQ(moved("skip.22", ten), Lines{"edit.move skips 0 22 24 32"});
  EXPECT_EQ(moved("skip.22", 100 * ten), Lines{"edit.move skips 0 22 24 45"});  // inside what is made
  EXPECT_EQ(moved("fill.20", ten), Lines{});
}

TEST_F(Timeline, WhatWasDraggedIsRemovedByDelete) {
  session.document.skeleton_edits = {DragEdit{4, LeftWrist, Vec3(0, 0.1f, 0), 5, false}};
  frame();
  EXPECT_EQ(dragged("drags.4", 0.5f, frames_wide(10)), Lines{"edit.move drags 4 14"});
  std::get<DragEdit>(session.document.skeleton_edits[0]).frame = 14;
  frame();
  key(render::Key::Delete);
  EXPECT_EQ(besides_frames(), Lines{"edit.remove drags 14"});
}

TEST_F(Timeline, AnEndOfABarIsDraggedAndTheOtherStays) {
  session.document.takes[0].pose_edits.skip = {22, 23, 24};
  frame();
  const float ten = frames_wide(10);
  EXPECT_EQ(dragged("swap.1", 1, ten), Lines{"edit.move swap 1 10 24"});
  EXPECT_EQ(dragged("swap.1", 0, -ten / 2), Lines{"edit.move swap 1 5 14"});
  EXPECT_EQ(dragged("swap.1", 0, -9 * ten), Lines{"edit.move swap 1 0 14"});
  EXPECT_EQ(dragged("skip.22", 1, ten), Lines{"edit.move skips 0 22 24 22 34"});
  EXPECT_EQ(dragged("skip.22", 0, 9 * ten), Lines{"edit.move skips 0 22 24 24 24"}) << "one frame is left";
  EXPECT_EQ(dragged("skip.22", 1, 9 * ten), Lines{"edit.move skips 0 22 24 22 47"}) << "inside what is made";
  EXPECT_EQ(dragged("fill.20", 1, ten), Lines{}) << "nobody's edit";
}

TEST_F(Timeline, ATrimmedEndIsDraggedByItsGrip) {
  const float ten = frames_wide(10);
  EXPECT_EQ(dragged("trim_first", 0.5f, ten), Lines{"edit.trim 0 12 40"});
  EXPECT_EQ(dragged("trim_last", 0.5f, -ten), Lines{"edit.trim 0 2 30"});
  EXPECT_EQ(dragged("trim_last", 0.5f, 9 * ten), Lines{"edit.trim 0 2 47"}) << "inside what is made";
  EXPECT_EQ(dragged("trim_first", 0.5f, -ten), Lines{"edit.trim 0 0 40"});
  session.source.count = 48;
  session.document.takes[0].pose_edits.trim->first = 0;
  frame();
  EXPECT_EQ(dragged("trim_last", 0.5f, 9 * ten), Lines{"edit.trim 0 off"}) << "nothing is left out";
  EXPECT_EQ(dragged("trim_last", 0.5f, 0), Lines{});
  session.document.takes[0].pose_edits.trim.reset();
  frame();
  EXPECT_FALSE(shown("timeline.track.trim_last"));
}

TEST_F(Timeline, WhileAnEndIsDraggedItsFrameIsShown) {
  queue.clear();
  const ImVec2 from = mark("timeline.track.trim_last").rect.at(0.5f, 0.5f);
  drag(from, {from.x - frames_wide(10), from.y});
  const Lines lines = asked();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "playback.frame 30"), 1);
}

TEST_F(Timeline, EscapeCancelsADragAndTheFrameShownComesBack) {
  for (const std::string name : {"trim_first", "trim_last", "swap.1", "drags.4", "loop_first"}) {
    const ImVec2 from = mark("timeline.track." + name).rect.at(0.5f, 0.5f);
    render::InputEvent button;
    button.kind = render::InputEvent::Kind::MouseButton, button.pressed = true;
    button.x = from.x, button.y = from.y;
    render::InputEvent move;
    move.x = from.x + 60, move.y = from.y;
    play({button}), play({move});
    session.playback.frame = 3, session.playback.in = 7;  // as it was asked for
    queue.clear();
    key(render::Key::Escape);
    Lines lines = asked();
    EXPECT_EQ(std::count(lines.begin(), lines.end(), "playback.frame 20"), 1) << name;
    EXPECT_EQ(std::count(lines.begin(), lines.end(), "playback.in 5"), name == "loop_first" ? 1 : 0) << name;
    session.playback.frame = 20, session.playback.in = 5;
    button.pressed = false, button.x = move.x;
    play({button});
    EXPECT_EQ(asked(), Lines{}) << name;
  }
}

TEST_F(Timeline, ThePointerShowsWhatIsDraggedSideways) {
  const auto shape = [&](const std::string& name, float x) {
    hover("timeline.track." + name, x);
    return gui.cursor();
  };
  const auto sideways = render::CursorShape::ResizeHorizontal;
  EXPECT_EQ(shape("trim_first", 0.5f), sideways);
  EXPECT_EQ(shape("swap.1", 0.01f), sideways);
  EXPECT_EQ(shape("swap.1", 0.99f), sideways);
  EXPECT_EQ(shape("loop_last", 0.5f), sideways);
  EXPECT_NE(shape("swap.1", 0.5f), sideways);
  EXPECT_NE(shape("fill.20", 0.99f), sideways);
}

TEST_F(Timeline, DeleteRemovesTheEditThatWasClickedAndNothingElse) {
  session.document.takes[0].pose_edits.skip = {22, 23, 24};
  session.document.takes[0].pose_edits.fill = {{30, 33}};
  frame();
  const auto deleted = [&](const std::string& name) {
    click("timeline.track." + name);
    queue.clear();
    key(render::Key::Delete);
    return asked();
  };
  EXPECT_EQ(deleted("drags.4"), Lines{"edit.remove drags 4"});
  EXPECT_EQ(deleted("swap.1"), Lines{"edit.remove skeleton 1"});
  EXPECT_EQ(deleted("rotations.12"), Lines{"edit.remove rotations 0 12"});
  EXPECT_EQ(deleted("skip.22"), Lines{"edit.skip 0 22 24 off"});
  EXPECT_EQ(deleted("made.0"), Lines{"edit.remove fill 0 0"});
  EXPECT_EQ(deleted("fill.20"), Lines{});
  click("timeline.track.drags.4");
  click(mark("timeline.track").rect.at(0.9f, 0.3f));
  queue.clear();
  key(render::Key::Delete);
  EXPECT_EQ(asked(), Lines{});
}

/// How high violet is drawn at a place of the track, pixels.
float violet_at(const ImDrawData& drawn, const ImU32 violet, float x) {
  float low = 1e9f, high = -1e9f;
  for (int n = 0; n < drawn.CmdListsCount; ++n) {
    const auto& list = *drawn.CmdLists[n];
    for (int i = 0; i + 5 < list.IdxBuffer.Size; i += 3) {
      const ImDrawVert* corner[3];
      for (int c = 0; c < 3; ++c) corner[c] = &list.VtxBuffer[list.IdxBuffer[i + c]];
      if (corner[0]->col != violet) continue;
      const auto [left, right] = std::minmax({corner[0]->pos.x, corner[1]->pos.x, corner[2]->pos.x});
      if (x < left || x > right) continue;
      for (const ImDrawVert* one : corner) low = std::min(low, one->pos.y), high = std::max(high, one->pos.y);
    }
  }
  return std::max(0.f, high - low);
}

TEST_F(Timeline, AFillIsAsHighAsItsDoubtFrameByFrame) {
  session.document.takes[0].pose_edits.fill = {{30, 33}};
  std::vector<float>& doubt_m = session.takes[0].shown.doubt_m;
  doubt_m.assign(session.takes[0].shown.poses.size(), 0.f);
  doubt_m[31] = 0.05f, doubt_m[32] = 0.3f, doubt_m[33] = 0.15f;
  const ImU32 violet = color(gui.ui().theme().series[4]);
  const ImDrawData& drawn = frame(2);
  const Rect bar = mark("timeline.track.made.0").rect, track = mark("timeline.track").rect;
  const auto high = [&](float at) { return violet_at(drawn, violet, track.at(at / 59, 0).x); };
  EXPECT_EQ(high(30), 0) << "known";
  EXPECT_NEAR(high(31), bar.height() / 3, 1) << "but for parts of a pixel";
  EXPECT_NEAR(high(32), bar.height(), 0.5f) << "never higher";
  EXPECT_NEAR(high(33), bar.height(), 0.5f) << "15 cm";
  EXPECT_EQ(high(35), 0) << "beside it";
  const float ten = frames_wide(10);
  EXPECT_EQ(dragged("made.0", 0.5f, ten), Lines{"edit.move fill 0 0 40"});
  EXPECT_EQ(dragged("made.0", 0.99f, ten), Lines{"edit.move fill 0 0 30 43"});
}

TEST_F(Timeline, MissingFramesAreOneRun) {
  for (int t = 24; t <= 26; ++t) flag_frame(t, printed("dance: frame %d is missing", 100 + t));
  ++session.source.generation;
  frame(2);
  EXPECT_NEAR(mark("timeline.track.fill.24").rect.width(), frames_wide(3), 1);
  EXPECT_FALSE(shown("timeline.track.fill.25"));
}

TEST_F(Timeline, AFillSaysItsFramesAndItsLargestDoubt) {
  session.document.takes[0].pose_edits.fill = {{30, 33}, {40, 40}};
  std::vector<float>& doubt_m = session.takes[0].shown.doubt_m;
  doubt_m.assign(41, 0.f);
  doubt_m[31] = 0.021f, doubt_m[32] = 0.012f;
  std::map<std::string, std::string> words;
  for (const EditMark& edit : edit_marks(session, {})) words[edit.mark.name] = edit.mark.words;
  EXPECT_EQ(words["made.0"], "Filled: frames 30 to 33, \u00b1 3 cm");
  EXPECT_EQ(words["made.1"], "Filled: frame 40") << "not made yet";
}

TEST_F(Timeline, TheEditedJointsChannelIsDrawnWithItsKeys) {
  EXPECT_FALSE(shown("timeline.track.key.0"));
  session.tool = app::Tool::Joints, session.selected_joint = LeftWrist;
  frame(2);
  const Rect track = mark("timeline.track").rect;
  EXPECT_NEAR(mark("timeline.track.key.0").rect.at(0.5f, 0).x, track.at(4.f / 59, 0).x, 1);
  EXPECT_TRUE(starts_with(panel_state<Channel>(context).label, "Left wrist: place"));
  session.tool = app::Tool::Bones, session.selected_joint = LeftElbow;
  frame(2);
  EXPECT_NEAR(mark("timeline.track.key.0").rect.at(0.5f, 0).x, track.at(12.f / 59, 0).x, 1);
  EXPECT_FALSE(shown("timeline.track.key.1"));
  session.tool = app::Tool::Look;
  frame(2);
  EXPECT_FALSE(shown("timeline.track.key.0"));
}

TEST_F(Timeline, EachFootOnTheFloorIsABarOfItsFrames) {
  EXPECT_FALSE(shown("timeline.track.left_foot.0"));
  std::vector<Standing>& standing = session.takes[0].shown.standing;
  standing.resize(48);
  for (size_t t = 5; t <= 14; ++t) standing[t][0] = true;
  for (size_t t = 20; t <= 29; ++t) standing[t][0] = standing[t][1] = true;
  frame();
  const Rect track = mark("timeline.track").rect;
  const auto x = [&](float at) { return track.at(at / 59, 0).x; };
  const Rect first = mark("timeline.track.left_foot.0").rect,
             right = mark("timeline.track.right_foot.0").rect;
  EXPECT_NEAR(first.min.x, x(4.5f), 1);
  EXPECT_NEAR(first.max.x, x(14.5f), 1);
  EXPECT_NEAR(mark("timeline.track.left_foot.1").rect.min.x, x(19.5f), 1);
  EXPECT_NEAR(right.min.x, x(19.5f), 1);
  EXPECT_LT(first.max.y, right.max.y);  // a row a foot
  EXPECT_FALSE(shown("timeline.track.right_foot.1"));
  for (const char* edit : {"drags.4", "swap.1", "rotations.12"})
    EXPECT_TRUE(intersection(mark(std::string("timeline.track.") + edit).rect, first).empty()) << edit;
  standing.resize(60);
  for (size_t t = 48; t < 60; ++t) standing[t][1] = true;  // more frames have come
  frame(2);
  EXPECT_TRUE(shown("timeline.track.right_foot.1"));
  standing.assign(60, Standing{false, true}), ++session.takes[0].generation;  // an edit has changed them
  frame(2);
  EXPECT_FALSE(shown("timeline.track.left_foot.0"));
  EXPECT_TRUE(shown("timeline.track.right_foot.0"));
  EXPECT_FALSE(shown("timeline.track.right_foot.1"));
  session.selected_take = 1;
  frame(2);
  EXPECT_FALSE(shown("timeline.track.right_foot.0"));
}

TEST_F(Timeline, AFootsBarIsNoEditAndItsTooltipTellsWhatHolds) {
  session.takes[0].shown.standing.assign(48, Standing{true, false});
  frame();
  EXPECT_EQ(contact_bands(session, state.standing)[0].words, "Left foot on the floor");
  const Rect bar = mark("timeline.track.left_foot.0").rect, track = mark("timeline.track").rect;
  queue.clear();
  click(ImVec2(track.at(30.f / 59, 0).x, bar.at(0, 0.5f).y));
  key(render::Key::Delete);
  const Lines lines = asked();
  ASSERT_FALSE(lines.empty());
  for (const std::string& line : lines) EXPECT_EQ(line, "playback.frame 30");  // as anywhere in the track
  session.document.takes[0].pose_edits.pin = PinEdit{};
  EXPECT_EQ(contact_bands(session, state.standing)[0].words, "Left foot pinned to the floor");
}

TEST_F(Timeline, KnowsTheBadFramesAndWhy) {
  EXPECT_EQ(state.why(20), "no points");
  EXPECT_EQ(state.why(31), "Low confidence");
  EXPECT_EQ(state.why(21), "");
  flag_frame(21, "too few points");
  ++session.source.generation;
  frame();
  EXPECT_EQ(state.why(21), "too few points");
}

TEST_F(Timeline, WhileFramesComeTheyAreLookedAtNowAndThenAndAtTheEndAll) {
  app::KeptSource bad = session.source.frames[20];
  for (int i = 0; i < 1000; ++i) session.source.frames.push_back(session.source.frames[1]);
  frame();
  session.source.frames.push_back(bad);
  frame();
  EXPECT_EQ(state.confidence.size(), 1049u);
  EXPECT_EQ(state.why(1048), "");
  session.working = false;
  frame();
  EXPECT_EQ(state.why(1048), "no points");
}

TEST_F(Timeline, WithoutFramesNothingCanBePressed) {
  session = app::Session();
  frame(2);
  for (const char* name :
       {"timeline.first", "timeline.play", "timeline.last", "timeline.in", "timeline.loop"})
    EXPECT_FALSE(mark(name).enabled) << name;
}

TEST_F(Timeline, ManyDigitsFitTheirFields) {
  session.source.count = 100000;
  for (int i = 48; i < 2000; ++i) session.source.frames.push_back(session.source.frames[1]);
  float frame_words = 0, time_words = 0;
  in_window([&](Ui&) {
    panel_of("timeline").draw(session, context);
    const float padding = 2 * ImGui::GetStyle().FramePadding.x;
    frame_words = ImGui::CalcTextSize("99999").x + padding;
    time_words = ImGui::CalcTextSize("59:59.99").x + padding;
  });
  for (const float scale : {1.f, 1.5f, 2.f}) {
    input.scale = scale, input.size = {static_cast<int>(1280 * scale), static_cast<int>(600 * scale)};
    frame(3);
    EXPECT_LE(frame_words, mark("timeline.frame").visible.width() + 1);
    EXPECT_LE(time_words, mark("timeline.time").visible.width() + 1);
  }
}

class Log : public PanelsTest {
 protected:
  Log() {
    input.size = {700, 300};
    panel("log");
  }
};

TEST_F(Log, CopiesClearsFiltersAndCloses) {
  expect_click("log.clear", {"log.clear"});
  expect_click("log.close", {"panel.show log off"});
  click("log.copy");
  EXPECT_STREQ(ImGui::GetClipboardText(), "opened dance\nframe 20 has no points\n");
  click("log.warnings");
  click("log.copy");
  EXPECT_STREQ(ImGui::GetClipboardText(), "frame 20 has no points\n");
}

TEST_F(PanelsTest, StatusShowsJobsAndCancelsThem) {
  input.size = {1280, 60};
  session.jobs.push_back({9, "Exporting dance.glb", -1, -1, true});
  panel([this] { draw_status(session, context, 60); });
  expect_click("status.job.cancel", {"job.cancel 7"});
  click("status.more_jobs");
  frame(2);
  EXPECT_TRUE(gui.find("status.job.9.cancel") != nullptr);
  click("status.rate");  // closes the list
  expect_click("status.message", {"panel.show log on"});
  EXPECT_TRUE(shown("status.rate"));
}

TEST_F(PanelsTest, StatusShowsHowFarScansAreCompletedAndStopsIt) {
  input.size = {1280, 60};
  session.jobs.clear();
  panel([this] { draw_status(session, context, 60); });
  frame(2);
  EXPECT_FALSE(shown("status.completing"));
  session.source.completing = 0.4f;
  frame(2);
  expect_click("status.completing.cancel", {"source.complete off"});
}

TEST_F(PanelsTest, StatusForgetsMessagesAfterTenSecondsAndErrorsWhenMended) {
  input.size = {1280, 60};
  panel([this] { draw_status(session, context, 60); });
  const auto after = [&](double seconds) {
    session.time = seconds;
    frame(2);
    return shown("status.message");
  };
  EXPECT_TRUE(after(9.9));
  EXPECT_FALSE(after(10.1));
  session.failures = {{"dance: no such folder", "source.open"}};
  EXPECT_TRUE(after(500));
  mend(session, "source.fps");
  EXPECT_TRUE(after(501));
  mend(session, "source.motion");  // another source is open
  EXPECT_FALSE(after(502));
}

TEST_F(PanelsTest, StartOpensSamplesRecentDocumentsAndDialogs) {
  input.size = {900, 800};
  session = app::Session();
  session.settings.recent = {"/home/ada/a dance.understudy"};
  session.settings.recent_sources = {"/data/dance"}, session.settings.recent_targets = {"/data/adult.glb"};
  const std::vector<SampleCard> samples = {{"A walk", "scans", {"/s/scan", "/s/adult.glb"}, nullptr}};
  panel([&] { draw_start(session, context, samples); });
  expect_click("start.sample.0", {"open /s/scan /s/adult.glb"});
  expect_click("start.recent.0", {"document.open \"/home/ada/a dance.understudy\""});
  expect_click("start.recent_source.0", {"open /data/dance"});
  session.settings.recent_sources = {app::recent_source("/bodies/a b.npz", "/data/walk.npz"), "/data/dance"};
  frame(2);
  expect_click("start.recent_source.0", {"source.motion \"/bodies/a b.npz\" /data/walk.npz"});
  expect_click("start.recent_source.1", {"open /data/dance"});
  expect_click("start.recent_target.0", {"open /data/adult.glb"});
  expect_click("start.open_source", {"dialog.open open_source"});
  expect_click("start.open_target", {"dialog.open open_target"});
  expect_click("start.open_document", {"dialog.open open_document"});
}

TEST(PanelWords, AreShortAndPlain) {
  EXPECT_EQ(argument(0.25), "0.25");
  EXPECT_EQ(argument(-1), "-1");
  EXPECT_EQ(joint_label(LeftWrist), "left wrist");
  EXPECT_EQ(joint_name(-1), "all");
  EXPECT_EQ(time_left(-1), "");
  EXPECT_EQ(time_left(12.2), "about 13 s left");
  EXPECT_EQ(time_left(600), "about 10 min left");
  EXPECT_EQ(file_name("/a/b/c.glb"), "c.glb");
  EXPECT_EQ(file_name("/a/b/"), "b");
  EXPECT_EQ(file_name("/"), "/");
  EXPECT_EQ(grouped(1234567), "1,234,567");
  EXPECT_EQ(grouped(-123), "-123");
  EXPECT_EQ(parse_number("0,5 m").value(), 0.5);
  EXPECT_FALSE(parse_number("m"));
  EXPECT_FALSE(parse_number("inf"));
}

TEST_F(WorkspaceTest, ASmallWindowWithLargeTextHasTheTrack) {
  input.size = {900, 600}, input.scale = 1.5f;
  frame(3);
  ASSERT_TRUE(shown("timeline.track"));
  const Mark track = mark("timeline.track");
  EXPECT_FLOAT_EQ(track.visible.max.y, track.rect.max.y) << "all of it";
  EXPECT_LE(track.rect.max.y, mark("status.document").rect.min.y);
  EXPECT_GT(mark("views").rect.height(), 200);
  take_log();
  click(track.rect.at(0.5f, 0.5f));
  const std::vector<std::string> asked = take_log();
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_TRUE(asked[0] == "playback.frame 29" || asked[0] == "playback.frame 30") << asked[0] << ", of 60";
}

TEST_F(WorkspaceTest, ALowWindowKeepsThePathAndTheButtonsOfTheExport) {
  input.size = {900, 600}, input.scale = 1.5f;
  workspace.open_dialog(session, "export");
  frame(5);
  for (const std::string name : {"export.path", "export.cancel", "export.save"})
    EXPECT_FLOAT_EQ(mark(name).visible.height(), mark(name).rect.height()) << name;
  EXPECT_FALSE(mark("export.format").visible.empty());
  gui.ui().reveal("export.in_place");
  frame(5);
  EXPECT_TRUE(shown("export.in_place")) << "by scrolling";
  EXPECT_TRUE(shown("export.save"));
}

TEST_F(PanelsTest, EveryKeyDoesOneThing) {
  std::vector<std::string> seen;
  for (const Binding& binding : bindings(studio.commands())) {
    EXPECT_EQ(std::count(seen.begin(), seen.end(), binding.keys), 0) << binding.keys << " does two things";
    seen.push_back(binding.keys);
  }
  EXPECT_EQ(keys_of(studio.commands(), "view.preset", {"front"}), "1");
  EXPECT_EQ(keys_of(studio.commands(), "tool", {"look"}), "Q");
  EXPECT_EQ(keys_of(studio.commands(), "document.save_as"), "Ctrl+Shift+S");
  EXPECT_EQ(keys_of(studio.commands(), "view.ortho", {"on"}), "5");
  EXPECT_EQ(keys_of(studio.commands(), "edit.swap"), "");
}

}  // namespace
}  // namespace understudy::ui
