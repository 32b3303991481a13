// How takes are performed: style and tempo.
#include <fstream>

#include "app/session/command_sets.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/style/manner_file.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

class PerformanceTest : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    studio.emplace(services());
    open_walk(*studio);
  }
  void TearDown() override {
    studio.reset();
    StudioTest::TearDown();
  }
  const Take& take(size_t k = 0) const { return studio->session().document.takes[k]; }
  const TakeState& state(size_t k = 0) const { return studio->session().takes[k]; }
  std::string refused(const std::string& command, const Arguments& arguments) {
    return failure_of([&] { studio->run(command, arguments); });
  }
  void run(const std::string& command, const Arguments& arguments) {
    studio->run(command, arguments);
    studio->wait_idle();
  }
  double clip_seconds() const {
    const auto inputs = export_inputs(studio->session(), {0}, {});
    return static_cast<double>(inputs[0].clips[0].poses.size() - 1) / inputs[0].clips[0].fps;
  }

  std::optional<Studio> studio;
};

TEST_F(PerformanceTest, AStyleChangesThePosesNotTheFramesAndIsUndone) {
  const Motion before = state().shown;
  const auto source = state().performed[40].source;
  run("method.style", {"0", "child"});
  EXPECT_EQ(take().method.style.name, "child");
  ASSERT_EQ(state().shown.poses.size(), before.poses.size());
  EXPECT_FALSE(same_poses(state().shown, before));
  EXPECT_EQ(state().performed[40].source, source) << "the source's skeleton is shown as it was seen";
  const Motion whole = state().shown;
  run("method.style_strength", {"0", "0.5"});
  const auto turned = [&](const Motion& motion) {
    return geodesic_angle(before.poses[40].local[Spine1], motion.poses[40].local[Spine1]);
  };
  EXPECT_GT(turned(whole), 0.02f);
  EXPECT_LT(turned(state().shown), 0.8f * turned(whole));
  run("method.style_strength", {"0", "0"});
  EXPECT_TRUE(same_poses(state().shown, before)) << "nothing of it is nothing";
  run("edit.undo", {});
  run("edit.undo", {});
  EXPECT_TRUE(take().method.style.called().empty());
  EXPECT_TRUE(same_poses(state().shown, before));
}

TEST_F(PerformanceTest, AStyleAsksForNoNewSkeletons) {
  Studio scans(services());
  open_both(scans);
  const int extracted = *extractions_;
  ASSERT_GE(extracted, kFrames);
  for (const char* const strength : {"1", "0.5", "0"}) {
    scans.run("method.style", {"0", "child"});
    scans.run("method.style_strength", {"0", strength});
    scans.wait_idle();
    EXPECT_EQ(ssize(scans.session().takes[0].performed), kFrames);
  }
  EXPECT_EQ(*extractions_, extracted);
}

TEST_F(PerformanceTest, AStrengthOutOfRangeIsBroughtInto) {
  run("method.style", {"0", "child"});
  run("method.style_strength", {"0", "7"});
  EXPECT_EQ(take().method.style.strength, 1.5f);
  EXPECT_NE(refused("method.style_strength", {"0", "much"}).find("is a number"), std::string::npos);
}

TEST_F(PerformanceTest, WhatIsNoStyleIsRefusedAndNothingChanges) {
  EXPECT_NE(refused("method.style", {"0", "chld"}).find("there is no style 'chld'"), std::string::npos);
  EXPECT_NE(refused("method.style", {"0", path("absent.json")}).find("there is no such file"),
            std::string::npos);
  std::ofstream(path("broken.json")) << "{\"understudy_style\": 1";
  EXPECT_NE(refused("method.style", {"0", path("broken.json")}).find("broken.json: is not the JSON"),
            std::string::npos);
  EXPECT_TRUE(take().method.style.called().empty());
  EXPECT_FALSE(studio->session().changed && take().method.style.any());
}

TEST_F(PerformanceTest, AStylesFileThatIsGoneEndsThatTakeAlone) {
  std::filesystem::copy_file(US_SOURCE_DIR "/assets/styles/old.json", path("mine.json"));
  run("compare.add", {"0"});
  run("method.style", {"0", path("mine.json")});
  EXPECT_EQ(take().method.style.file, path("mine.json"));
  std::filesystem::remove(path("mine.json"));
  run("method.style_strength", {"0", "0.8"});
  EXPECT_NE(state(0).problem.find("mine.json: there is no such file"), std::string::npos) << state(0).problem;
  EXPECT_TRUE(state(1).problem.empty());
  EXPECT_FALSE(state(1).shown.poses.empty());
}

TEST_F(PerformanceTest, TheRightsOfAStyleGoIntoWhatIsExported) {
  const auto with_rights = [&](const std::string& name, const std::string& licence,
                               const std::string& whose) {
    MannerFile file = read_manner(US_SOURCE_DIR "/assets/styles/old.json");
    file.note.label = name, file.note.licence = licence, file.note.attribution = whose;
    std::ofstream(path(name + ".json")) << to_json(file);
    return path(name + ".json");
  };
  const auto exported = [&](const std::string& file, const Arguments& more = {}) {
    Arguments arguments = {"0", path(file)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run("export.run", arguments);
    return read_file(path(file));
  };
  const auto has = [](const std::string& file, const std::string& words) {
    return file.find(words) != std::string::npos;
  };
  EXPECT_FALSE(has(exported("plain.glb"), "copyright"));
  run("method.style", {"0", with_rights("bought", "CC BY-NC 4.0", "")});
  const std::string bought = "Performed in the style bought, CC BY-NC 4.0 (non-commercial)";
  EXPECT_TRUE(has(exported("bought.glb"), "\"copyright\":\"" + bought + "\""));
  run("compare.add", {"0", "style=" + with_rights("lent", "CC BY 4.0", "by Somebody")});
  run("take.rename", {"1", "other"});
  const std::string lent = "Performed in the style lent, CC BY 4.0, by Somebody";
  EXPECT_TRUE(has(exported("both.glb", {"take=other"}), bought + "; " + lent)) << "clips of one file";
  run("export.all", {path("all"), "format=glb"});
  EXPECT_TRUE(has(read_file(path("all/target.glb")), bought));
  EXPECT_FALSE(has(read_file(path("all/target.glb")), lent));
  EXPECT_TRUE(has(read_file(path("all/other.glb")), lent));
  run("method.style", {"0", "old"});
  EXPECT_FALSE(has(exported("free.glb"), "copyright")) << "its own licence asks for nothing";
}

TEST_F(PerformanceTest, ATakeInAStyleIsComparedWithOneWithout) {
  const Motion before = state().shown;
  run("method.style", {"0", "old"});
  run("compare.add", {"0", "style=none"});
  ASSERT_EQ(studio->session().takes.size(), 2u);
  EXPECT_TRUE(same_poses(state(1).shown, before));
  EXPECT_FALSE(same_poses(state(0).shown, before));
}

TEST_F(PerformanceTest, TheTempoChangesWhenFramesAreShownNotThem) {
  const Motion before = state().shown;
  const double seconds = clip_seconds();
  run("edit.tempo", {"0", "0.5"});
  EXPECT_TRUE(same_poses(state().shown, before));
  ASSERT_EQ(state().times.size(), before.poses.size());
  EXPECT_NEAR(clip_seconds(), seconds / 2, 0.05);
  run("edit.tempo", {"0", "2"});
  EXPECT_NEAR(clip_seconds(), 2 * seconds, 0.05);
  run("edit.trim", {"0", "0", "30"});
  EXPECT_NEAR(clip_seconds(), 2 * 30 / studio->session().source.fps, 0.05);
  run("edit.undo", {});
  run("edit.tempo", {"0", "body"});
  const float ratio = leg_length(state().target->joints) / leg_length(state().performed[0].source);
  EXPECT_NEAR(state().times.back(), std::sqrt(static_cast<double>(ratio)) * seconds, 0.02 * seconds);
  run("edit.tempo", {"0", "off"});
  EXPECT_TRUE(state().times.empty());
  EXPECT_NEAR(clip_seconds(), seconds, 1e-6);
  EXPECT_NE(refused("edit.tempo", {"0", "fast"}).find("is a number"), std::string::npos);
}

TEST_F(PerformanceTest, PlaybackGoesAtTheTempo) {
  Studio& s = *studio;
  s.run("edit.tempo", {"0", "0.5"});
  s.wait_idle();
  s.run("playback.frame", {"0"});
  s.run("playback.toggle");
  s.tick(0.5, 0.5);
  EXPECT_NEAR(s.session().playback.frame, s.session().source.fps, 2);
}

TEST_F(PerformanceTest, TheClockIsTheCurrentTakesAndAllViewsShowTheSameMomentOfTheAction) {
  Studio& s = *studio;
  run("edit.tempo", {"0", "2"});
  run("edit.tempo_phase", {"0", "stroke", "0.6"});
  run("compare.add", {"0"});
  run("edit.tempo", {"1", "off"});
  s.run("view.pane", {"1"});
  ASSERT_EQ(s.session().selected_take, 0);
  for (const int frame : {0, 1, 40, 99}) {
    const double moment = moment_of(s.session(), frame);
    EXPECT_EQ(moment, state().times[static_cast<size_t>(frame)]);
    s.run("playback.seek", {std::to_string(moment + 1e-4)});
    EXPECT_EQ(shown_frame(s.session()), frame);
  }
  const int frame = shown_frame(s.session());
  s.run("view.pane", {"2"});
  EXPECT_EQ(shown_frame(s.session()), frame) << "the same moment of the action";
  EXPECT_DOUBLE_EQ(moment_of(s.session(), frame), frame / s.session().source.fps);
  // Playback goes by the clock.
  for (const char* const pane : {"1", "2"}) {
    s.run("view.pane", {pane});
    s.run("playback.frame", {"10"});
    s.run("playback.play");
    const double began = moment_of(s.session(), s.session().playback.frame);
    for (int i = 0; i < 50; ++i) s.tick(0.01, 0.01);
    EXPECT_NEAR(moment_of(s.session(), s.session().playback.frame), began + 0.5, 0.02) << pane;
    s.run("playback.pause");
  }
}

TEST_F(PerformanceTest, TheTableOfFiguresHasTheStylesInBothTimes) {
  run("method.style", {"0", "child"});
  const auto table = [&] {
    run("export.csv", {"0", path("figures.csv")});
    return read_file(path("figures.csv"));
  };
  const auto turn = [&] { return find(state().series, "head_turn")->values[40]; };
  const std::string plain = table();
  EXPECT_EQ(plain.rfind("frame,seconds,confidence", 0), 0u) << plain.substr(0, 100);
  EXPECT_NE(plain.find("head_turn"), std::string::npos);
  EXPECT_NE(plain.find("pelvis_speed"), std::string::npos);
  const float before = turn();
  run("edit.tempo", {"0", "2"});
  EXPECT_NEAR(turn(), before / 2, 1e-3f * before) << "as it is seen";
  const std::string slow = table();
  EXPECT_EQ(slow.rfind("frame,seconds,take_seconds,confidence", 0), 0u) << slow.substr(0, 100);
  EXPECT_NE(slow.find("\n30,1,2,"), std::string::npos) << "at 30 frames/s";
}

TEST_F(PerformanceTest, MomentsAreHeldAndShiftedAndNotTurnedBack) {
  run("edit.tempo_mark", {"0", "30"});
  EXPECT_EQ(take().pose_edits.tempo->by, TempoBy::Number);
  const double fps = studio->session().source.fps;
  run("edit.tempo_mark", {"0", "60"});
  run("edit.move", {"tempo", "0", "1", "75"});  // frame 60 is shown when 75 was
  EXPECT_NEAR(state().times[60], 75 / fps, 1e-3);
  EXPECT_NEAR(state().times[30], 30 / fps, 1e-3);
  EXPECT_NE(refused("edit.move", {"tempo", "0", "1", "10"}).find("turn it back"), std::string::npos);
  EXPECT_NEAR(take().pose_edits.tempo->marks[1].later_s, 15 / fps, 1e-3) << "what is refused changes nothing";
  run("edit.remove", {"tempo", "0", "1"});
  EXPECT_EQ(take().pose_edits.tempo->marks.size(), 1u);
  EXPECT_NE(refused("edit.remove", {"tempo", "0", "5"}).find("there is no mark 5"), std::string::npos);
  EXPECT_NE(refused("edit.tempo_mark", {"0", "9999"}).find("there is no frame"), std::string::npos);
}

TEST_F(PerformanceTest, TheStylesTempoIsTaken) {
  EXPECT_NE(refused("edit.tempo_style", {"0"}).find("has no style"), std::string::npos);
  run("method.style", {"0", "child"});
  run("edit.tempo_style", {"0"});
  EXPECT_FLOAT_EQ(take().pose_edits.tempo->stroke, 0.83f);
  EXPECT_FLOAT_EQ(take().pose_edits.tempo->spread, 0.036f);
  run("edit.tempo_phase", {"0", "stroke", "0.6"});
  EXPECT_FLOAT_EQ(take().pose_edits.tempo->stroke, 0.6f);
  EXPECT_NE(refused("edit.tempo_phase", {"0", "pause", "0.6"}).find("phase is one of"), std::string::npos);
}

TEST_F(PerformanceTest, HowItIsPerformedIsMeasuredAtItsTempo) {
  const auto value = [&](const char* key) {
    for (const auto& [name, figure] : state().metrics)
      if (name == key) return figure;
    return -1.0;
  };
  EXPECT_EQ(value("cycle_s"), -1) << "nobody asked";
  run("edit.tempo", {"0", "1"});
  const double cycle = value("cycle_s");
  EXPECT_GT(cycle, 0.4);
  run("edit.tempo", {"0", "0.7"});
  EXPECT_NEAR(value("cycle_s"), 0.7 * cycle, 0.05 * cycle);
}

}  // namespace
}  // namespace understudy::app
