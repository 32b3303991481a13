// The shipped program in a real window on a display of its own, driven by real input.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/session/document_file.hpp"
#include "tests/app/program.hpp"
#include "tests/studio/studio_window.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;

TEST_F(StudioWindow, OpensPlaysScrubsEditsSavesExportsAndQuits) {
  start();
  click("start.sample.1");
  ASSERT_TRUE(wait_until([&] { return facts_["ready_takes"] == "1" && facts_["working"] == "no"; }))
      << seen();
  const int frames = std::stoi(facts_["frames"]);
  ASSERT_GE(frames, 40);

  key("Home");
  expect_fact("frame", "0");
  click("timeline.play");
  expect_fact("playing", "yes");
  ASSERT_TRUE(wait_until([&] { return std::stoi(facts_["frame"]) > 2; }));
  key("space");
  expect_fact("playing", "no");

  const Place track = place("timeline.track");
  drag({track.x - 100, track.y}, {track.x, track.y});
  ASSERT_TRUE(wait_until([&] { return std::abs(std::stoi(facts_["frame"]) - frames / 2) < frames / 4; }))
      << seen();

  click("tools.joints");
  expect_fact("tool", "joints");
  const Place wrist = place("joint.0.left_wrist");
  drag(wrist, {wrist.x + 30, wrist.y - 40});
  expect_fact("skeleton_edits", "1");
  EXPECT_NE(facts_["undo_label"], "");
  key("ctrl+z");
  expect_fact("skeleton_edits", "0");
  key("ctrl+shift+z");
  expect_fact("skeleton_edits", "1");
  expect_fact("working", "no");

  key("ctrl+s");
  click("browser.name");
  key("ctrl+a");
  type(scratch.path("dance.understudy"));
  key("Return");
  expect_fact("changed", "no");

  key("ctrl+e");
  click("export.path");
  key("ctrl+a");
  type(scratch.path("dance.glb"));
  key("Tab");
  click("export.save");
  ASSERT_TRUE(wait_until([&] { return fs::exists(scratch.path("dance.glb")) && facts_["jobs"] == "0"; }))
      << seen();

  key("ctrl+q");
  const Finished end = program->finish();
  EXPECT_EQ(end.code, 0) << end.err;

  const app::SavedDocument saved = app::read_document(scratch.path("dance.understudy"));
  EXPECT_EQ(saved.document.skeleton_edits.size(), 1u);
  EXPECT_EQ(saved.document.takes.size(), 1u);
  const std::string glb = read_bytes(scratch.path("dance.glb"));
  ASSERT_GT(glb.size(), 20u);
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const auto json = nlohmann::json::parse(glb.substr(20, length));
  EXPECT_EQ(json["animations"].size(), 1u);
  EXPECT_EQ(json["skins"].size(), 1u);
  EXPECT_TRUE(app::found_autosaves(scratch.path("state")).empty());
}

TEST_F(StudioWindow, ARecordingOfItReplaysWithoutOne) {
  const std::string recording = scratch.path("recording.us");
  start({"--record", recording});
  click("start.sample.1");
  ASSERT_TRUE(wait_until([&] { return facts_["ready_takes"] == "1" && facts_["working"] == "no"; }))
      << seen();
  click("timeline.first");
  expect_fact("frame", "0");
  click("timeline.forward");
  expect_fact("frame", "1");
  key("Right");
  expect_fact("frame", "2");
  key("ctrl+q");
  click("unsaved.no");
  EXPECT_EQ(program->finish().code, 0);
  std::string text = read_bytes(recording);
  EXPECT_NE(text.find("# -> playback.step_on"), std::string::npos) << text;
  const size_t end = text.rfind("event key LeftControl down");  // of Ctrl+Q
  ASSERT_NE(end, std::string::npos) << text;
  text.insert(end, "frames 2\nexpect_value frame 2\n");
  std::ofstream(recording) << text;
  for (const char* context : {"null", "egl"}) {
    ProgramOptions options;
    options.patience_s = kPatience;
    const Finished replay = run_program({"play", recording, "--context", context}, options);
    EXPECT_EQ(replay.code, 0) << context << replay.err;
  }
}

TEST_F(StudioWindow, OffersTheSoftwareRendererWhereOpenGlIsTooOld) {
  ProgramOptions options;
  options.environment = {"DISPLAY=" + display.name(), "WAYLAND_DISPLAY=", "MESA_GL_VERSION_OVERRIDE=2.1",
                         "UNDERSTUDY_CONFIG=" + scratch.path("config"),
                         "UNDERSTUDY_STATE=" + scratch.path("state")};
  const Finished run = run_program({"studio"}, options);
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.err.find("--software"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace understudy::tests
