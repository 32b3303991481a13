#include <chrono>
#include <thread>

#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

TEST_F(StudioTest, ASavedDocumentGivesTheSameResult) {
  Motion before;
  {
    Studio studio(services());
    open_both(studio);
    studio.run("edit.drag", {"4", "right_wrist", "0.1", "0", "0"});
    studio.run("edit.rotate", {"0", "6", "head", "0", "0.4", "0", "3"});
    studio.run("edit.skip", {"0", "3", "on"});
    studio.wait_idle();
    before = studio.session().takes[0].shown;
    studio.run("document.save_as", {path("dance")});
    EXPECT_FALSE(studio.session().changed);
  }
  Studio studio(services());
  studio.run("document.open", {path("dance.understudy")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty());
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.skip.count(3), 1u);
}

/// The dance with two scans a second left out after its fourth.
std::string times_with_a_gap(int scans) {
  std::string text = "frame,seconds\n";
  for (int i = 0; i < scans; ++i) text += printed("%d,%.3f\n", i, 0.05 * (i < 4 ? i : i + 2));
  return text;
}

TEST_F(StudioTest, TimesOfTheScansMakeGapsCanBeUndoneAndAreSaved) {
  std::ofstream(path("times.csv")) << times_with_a_gap(kFrames);
  {
    Studio studio(services());
    const Session& session = studio.session();
    open_both(studio);
    studio.run("source.times", {"times.csv"});
    studio.wait_idle();
    EXPECT_EQ(session.document.source.times, path("times.csv"));
    EXPECT_EQ(session.source.fps, 20);
    ASSERT_EQ(frame_count(session), kFrames + 2);
    for (int t = 0; t < kFrames + 2; ++t) EXPECT_EQ(session.source.frames[t].flagged, t == 4 || t == 5) << t;
    EXPECT_NE(session.source.frames[4].reason.find("frame 4 is missing"), std::string::npos);
    EXPECT_EQ(session.history.undo_label(), "Times of the scans");
    studio.run("edit.undo");
    studio.wait_idle();
    EXPECT_EQ(frame_count(session), kFrames);
    EXPECT_EQ(session.source.fps, 30);
    studio.run("edit.redo");
    studio.run("source.times", {"off"});
    EXPECT_EQ(session.document.source.times, "");
    studio.run("edit.undo");
    studio.run("document.save_as", {path("dance")});
  }
  fs::create_directory(path("elsewhere"));
  for (const char* file : {"times.csv", "scan.npz", "target.obj", "dance.understudy"})
    fs::rename(path(file), path(std::string("elsewhere/") + file));
  Studio studio(services());
  studio.run("document.open", {path("elsewhere/dance.understudy")});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.source.times, path("elsewhere/times.csv"));
  EXPECT_EQ(frame_count(studio.session()), kFrames + 2);
  EXPECT_EQ(studio.session().source.fps, 20);
}

TEST_F(StudioTest, TimesThatAreNotThoseOfTheScansAreRefusedAtOnce) {
  std::ofstream(path("few.csv")) << "0,0\n1,0.1\n";
  std::ofstream(path("falls.csv")) << times_with_a_gap(kFrames - 1) << kFrames - 1 << ",0\n";
  Studio studio(services());
  const auto refused = [&](const char* file) {
    try {
      studio.run("source.times", {file});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("few.csv").find("no scans are open"), std::string::npos);
  open_both(studio);
  EXPECT_NE(refused("few.csv").find("few.csv: has no time for frame 2"), std::string::npos);
  EXPECT_NE(refused("falls.csv").find("falls.csv: line 25: the time falls"), std::string::npos);
  EXPECT_NE(refused("gone.csv").find("gone.csv"), std::string::npos);
  EXPECT_EQ(studio.session().document.source.times, "");
}

TEST_F(StudioTest, ScansAreCompletedCanBeUndoneAndAreSavedAsARecipe) {
  {
    Studio studio(services());
    const Session& session = studio.session();
    open_both(studio);
    studio.run("source.complete", {"60"});
    float told = -1;
    for (int i = 0; i < 60000 && (session.source.fps != 60 || session.source.frames.size() == 0); ++i) {
      studio.tick(0.001);
      told = std::max(told, session.source.completing);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_GT(told, 0) << "how far it is";
    EXPECT_LT(session.source.completing, 0) << "done";
    studio.wait_idle();
    EXPECT_EQ(session.source.problem, "");
    EXPECT_EQ(session.source.fps, 60);
    ASSERT_EQ(frame_count(session), 2 * kFrames - 1);
    for (const KeptSource& frame : session.source.frames) {
      EXPECT_TRUE(frame.exact);
      EXPECT_FALSE(frame.flagged) << frame.reason;
    }
    EXPECT_NE(session.source.decision.find("looks both ways"), std::string::npos) << session.source.decision;
    studio.run("edit.undo");
    studio.wait_idle();
    EXPECT_EQ(frame_count(session), kFrames);
    EXPECT_FALSE(session.source.frames[0].exact);
    studio.run("edit.redo");
    studio.run("document.save_as", {path("dance")});
  }
  EXPECT_LT(fs::file_size(path("dance.understudy")), 20000u) << "the recipe, not its frames";
  Studio studio(services());
  studio.run("document.open", {path("dance.understudy")});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.source.complete, 60);
  EXPECT_EQ(frame_count(studio.session()), 2 * kFrames - 1);
  fs::remove(path("scan.npz"));
  studio.run("work.restart");
  studio.wait_idle();
  EXPECT_NE(studio.session().source.problem.find("scan.npz"), std::string::npos)
      << "a recipe whose file is gone: " << studio.session().source.problem;
}

TEST_F(StudioTest, WhatCannotBeCompletedIsRefusedAtOnce) {
  Studio studio(services());
  const auto refused = [&](const char* command, const std::string& argument) {
    return failure_of([&] { studio.run(command, {argument}); });
  };
  EXPECT_EQ(refused("source.complete", "60"), "no scans are open that could be completed");
  open_both(studio);
  EXPECT_EQ(refused("source.complete", "0.5"), "a frame rate is 1 to 1000, not 0.5");
  std::ofstream(path("markers.csv")) << "seconds,name,x,y,z\n0,tail,0,0,0\n0,horn,0,0,0\n0,wing,0,0,0\n";
  EXPECT_NE(refused("source.markers", "markers.csv").find("(--complete)"), std::string::npos);
  studio.run("source.complete", {"60"});
  EXPECT_NE(refused("source.markers", "markers.csv").find("there is no place for a marker 'horn'"),
            std::string::npos)
      << refused("source.markers", "markers.csv");
  EXPECT_NE(refused("source.markers", "gone.csv").find("gone.csv"), std::string::npos);
}

TEST_F(StudioTest, AnotherSourceHasNoTimes) {
  std::ofstream(path("times.csv")) << times_with_a_gap(kFrames);
  fs::copy_file(path("scan.npz"), path("other.npz"));
  Studio studio(services());
  open_both(studio);
  studio.run("source.times", {"times.csv"});
  studio.run("source.open", {path("other.npz")});
  EXPECT_EQ(studio.session().document.source.times, "");
}

/// The view that is framed and the take that commands act on: one, before and after.
void expect_current(const Session& session, int take, const std::string& when) {
  EXPECT_EQ(session.selected_take, take) << when;
  EXPECT_EQ(session.view.active_pane, take + 1) << when;
}

TEST_F(StudioTest, AReopenedDocumentFramesTheTakeThatCommandsActOn) {
  fs::copy_file(path("target.obj"), path("other.obj"));
  for (const bool source_framed : {false, true}) {
    const std::string document = path(source_framed ? "a.understudy" : "b.understudy");
    {
      Studio studio(services());
      open_both(studio);
      studio.run("open", {path("other.obj")});
      expect_current(studio.session(), 1, "added");
      if (source_framed) studio.run("view.pane", {"0"});
      studio.run("document.save_as", {document});
    }
    Studio studio(services());
    studio.run("open", {path("target.obj")});
    studio.session().changed = false;
    studio.run("document.open", {document});
    EXPECT_EQ(studio.session().selected_take, 1);
    EXPECT_EQ(studio.session().view.active_pane, source_framed ? 0 : 2);
  }
}

TEST_F(StudioTest, ADocumentOfBeforeFramesTheTakeOfItsActiveView) {
  SavedDocument saved;
  saved.document.takes.resize(3);
  for (Take& take : saved.document.takes) take.target.path = path("target.obj");
  saved.view.active_pane = 3;
  write_document(path("old.understudy"), saved);
  Studio studio(services());
  studio.run("document.open", {path("old.understudy")});
  expect_current(studio.session(), 2, "opened");
}

TEST_F(StudioTest, TheCurrentTakeStaysWhenAnotherGoesAndComesBackFromTheNotice) {
  Studio studio(services());
  Session& session = studio.session();
  for (const char* name : {"a.obj", "b.obj", "c.obj"}) {
    fs::copy_file(path("target.obj"), path(name));
    studio.run("open", {path(name)});
  }
  studio.run("edit.turn", {"0", "30"});
  studio.run("target.select", {"1"});
  studio.run("target.remove", {"0"});
  expect_current(session, 0, "another removed");
  EXPECT_EQ(session.document.takes[0].name, "b");
  EXPECT_EQ(session.history.undo_label(), "Remove a");
  ASSERT_FALSE(session.notices.empty());
  const Notice notice = session.notices.back();
  EXPECT_EQ(notice.text, "Removed a with its edits");
  EXPECT_EQ(notice.offer.label, "Undo");
  const Arguments words = split_line(notice.offer.command);
  studio.run(words[0], {words.begin() + 1, words.end()});
  ASSERT_EQ(session.document.takes.size(), 3u);
  EXPECT_TRUE(session.document.takes[0].pose_edits.turn);
  expect_current(session, 0, "undone");
  studio.run("take.rename", {"2", "d"});
  EXPECT_THROW(studio.run(words[0], {words.begin() + 1, words.end()}), Error)
      << "another step came meanwhile";
  EXPECT_EQ(session.document.takes[2].name, "d");
}

TEST_F(StudioTest, AsksBeforeUnsavedWorkIsLost) {
  Studio studio(services());
  open_both(studio);
  studio.run("app.quit");
  ASSERT_TRUE(studio.session().question);
  EXPECT_FALSE(studio.session().quit);
  studio.run("question.answer", {"cancel"});
  EXPECT_FALSE(studio.session().quit);
  studio.run("app.quit");
  studio.run("question.answer", {"discard"});
  EXPECT_TRUE(studio.session().quit);
}

TEST_F(StudioTest, WhatWasSavedOrClosedLeavesNoCopyForRecovery) {
  const auto no_copy = [this] { return !fs::exists(path("state")) || fs::is_empty(path("state")); };
  for (int round = 0; round < 20; ++round) {
    Studio studio(services());
    studio.session().settings.autosave_s = 0;
    studio.run("target.add", {path("target.obj")});
    studio.tick(1);  // starts writing the copy
    if (round % 2) studio.run("document.save_as", {path("saved.understudy")});
    if (round % 2) {
      while (studio.jobs().running()) studio.tick(0);
      EXPECT_TRUE(no_copy()) << round;
    } else {
      studio.run("app.quit");
      studio.run("question.answer", {"discard"});
    }
  }
  EXPECT_TRUE(no_copy());
}

TEST_F(StudioTest, WhatEndsUnsavedKeepsItsCopy) {
  { Studio(services()).run("target.add", {path("target.obj")}); }
  ASSERT_TRUE(fs::exists(path("state")));
  const fs::path copy = fs::directory_iterator(path("state"))->path();
  EXPECT_EQ(read_autosave({copy.string(), "", ""}).document.takes.size(), 1u);
}

TEST_F(StudioTest, ACopyForRecoveryThatCannotBeWrittenIsToldOnceAndInNoDialog) {
  std::ofstream(path("state")) << "a file where the folder should be";
  Studio studio(services());
  studio.session().settings.autosave_s = 0;
  studio.run("target.add", {path("target.obj")});
  int told = 0;
  for (int i = 0; i < 5; ++i) {
    studio.session().notices.clear();
    studio.tick(1);
    studio.wait_idle();
    for (const Notice& notice : studio.session().notices) told += notice.kind == Notice::Kind::Warning;
  }
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_EQ(told, 1);
}

TEST_F(StudioTest, MissingFilesAreAskedForAndFound) {
  {
    Studio studio(services());
    open_both(studio);
    studio.run("document.save_as", {path("dance.understudy")});
  }
  fs::create_directory(path("elsewhere"));
  fs::rename(path("scan.npz"), path("elsewhere/scan.npz"));
  Studio studio(services());
  studio.run("document.open", {path("dance.understudy")});
  ASSERT_TRUE(studio.session().question);
  EXPECT_EQ(studio.session().question->missing, std::vector<std::string>{path("scan.npz")});
  studio.wait_idle();
  EXPECT_TRUE(studio.session().errors.empty()) << "told twice: " << studio.session().errors.front().text;
  EXPECT_TRUE(studio.session().takes[0].ready);
  studio.run("document.relocate", {path("scan.npz"), path("elsewhere/scan.npz")});
  studio.wait_idle();
  EXPECT_FALSE(studio.session().question);
  EXPECT_EQ(frame_count(studio.session()), kFrames);
}

TEST_F(StudioTest, ACaseComesWithItsTruth) {
  const fs::path folder = folder_ / "case";
  fs::create_directory(folder);
  fs::copy_file(path("scan.npz"), folder / "source.npz");
  fs::copy_file(path("target.obj"), folder / "target.obj");
  std::ofstream(folder / "case.json") << R"({"fps": 30, "source": "source.npz", "target": "target.obj",
    "truth": "truth.npz", "tags": []})";
  NpyArray joints;
  joints.shape = {kFrames, kJointCount, 3};
  for (int t = 0; t < kFrames; ++t) {
    const Joints posed =
        forward_kinematics(human_rest(), fixtures::dance(0.1f * static_cast<float>(t))).joints;
    joints.values.insert(joints.values.end(), posed.data(), posed.data() + posed.size());
  }
  write_npz((folder / "truth.npz").string(), {{"joints", joints}, {"source_joints", joints}});
  Studio studio(services());
  studio.run("open", {folder.string()});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  const Series* const error = find(studio.session().takes[0].series, "extraction_mpjpe_mm");
  ASSERT_NE(error, nullptr);
  EXPECT_NEAR(error->values[10], 120,
              30);  // the import lifts the scan onto the floor, the truth here does not
  EXPECT_NE(find(studio.session().takes[0].series, "pa_mpjpe_m"), nullptr);
}

TEST_F(StudioTest, ANewDocumentIsEmptyWhateverWasBeingMade) {
  Studio studio(services());
  for (int round = 0; round < 40; ++round) {
    studio.run("source.open", {path("scan.npz")});
    studio.run("target.add", {path("target.obj")});
    for (int i = 0; i < round; ++i) studio.tick(0.001);
    studio.replace_document({}, "");
    studio.wait_idle();
    ASSERT_TRUE(studio.session().source.frames.empty()) << round;
    ASSERT_TRUE(studio.session().takes.empty());
  }
}

}  // namespace
}  // namespace understudy::app
