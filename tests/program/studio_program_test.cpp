// The shipped studio without a window: scripts on each context, recovery after a crash, the tour of
// screenshots.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/session/document_file.hpp"
#include "render/image.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;

class StudioProgram : public testing::Test {
 protected:
  std::string script(const std::string& name, const std::string& text) {
    write_text(scratch.path(name), text);
    return scratch.path(name);
  }
  Finished play(const std::string& text, std::vector<std::string> more = {}, ProgramOptions options = {}) {
    std::vector<std::string> arguments = {"play", script("test.us", text), "--out", scratch.path("out")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (options.patience_s <= 100) options.patience_s = 400;
    return run_program(arguments, std::move(options));
  }
  void expect_sentence(const Finished& run, const std::string& says) {
    EXPECT_EQ(run.code, 1) << run.err;
    const size_t at = run.err.rfind("understudy: ");
    ASSERT_NE(at, std::string::npos) << run.err;
    EXPECT_EQ(line_count(run.err.substr(at)), 1) << run.err;
    EXPECT_NE(run.err.find(says, at), std::string::npos) << run.err;
  }
  ScratchFolder scratch;
};

/// How many different colours a picture has, a hundred at most.
size_t colours(const render::Image& image) {
  std::set<uint32_t> found;
  for (size_t i = 0; i + 2 < image.pixels.size() && found.size() < 100; i += 3)
    found.insert(
        static_cast<uint32_t>(image.pixels[i] << 16 | image.pixels[i + 1] << 8 | image.pixels[i + 2]));
  return found.size();
}

constexpr const char* kWalk =
    "open samples/walk samples/target_child.glb\nwait\nexpect_value frames 45\nplayback.frame 20\n";

TEST_F(StudioProgram, AStudyOfTheOpenTakesIsLookedAtAndRendered) {
  const Finished run =
      play(std::string(kWalk) +
               "compare.add 0 engine=paper\nwait\nstudy.new takes\nstudy.add_question likert\n"
               "study.set clip.seconds 0.5\nstudy.set picture.width 192\n"
               "study.set picture.height 108\nframes 3\nwait\nframes 3\nexpect study.picture\n"
               "screenshot panel.png\nstudy.render out/stimuli\nwait\n"
               "expect_text \"Rendered 2 clips\"\n",
           {"--context", "egl", "--size", "1280x2000"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(fs::exists(scratch.path("out/stimuli/manifest.json")));
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path("out/stimuli/clips")), {}), 2);
}

TEST_F(StudioProgram, PlaysTheSameScriptOnEveryContext) {
  for (const char* context : {"null", "egl", "osmesa"}) {
    const std::string text = std::string(kWalk) +
                             "click timeline.forward\nexpect_value frame 21\nview.layout overlay\n"
                             "expect_value layout overlay\nkey Ctrl+Z\nscreenshot seen.png\n";
    const Finished run = play(text, {"--context", context, "--size", "640x480"});
    EXPECT_EQ(run.code, 0) << context << run.err;
    const render::Image image = render::read_png(scratch.path("out/seen.png"));
    EXPECT_EQ(image.width, 640);
    if (std::string(context) != "null") EXPECT_EQ(colours(image), 100u) << context;
  }
}

TEST_F(StudioProgram, ABadLineEndsItWithOneSentence) {
  expect_sentence(play("frames 2\nview.layout sideways\n", {"--context", "null"}), "test.us:2: ");
  expect_sentence(play("click nowhere\n", {"--context", "null"}), "test.us:1: nothing on the screen");
  expect_sentence(run_program({"play", scratch.path("none.us")}), "none.us: there is no such file");
  expect_sentence(play("frames 1", {"--size", "big"}), "big is not a size: WIDTHxHEIGHT");
  expect_sentence(play("open samples/nothing\n", {"--context", "null"}), "nothing");
}

TEST_F(StudioProgram, AnErrorThatNobodyExpectedFailsTheScript) {
  expect_sentence(play("drop /no/such/scan\nframes 3\n", {"--context", "null"}), "ended with an error");
}

TEST_F(StudioProgram, SaysThatThereIsNoOpenGl) {
  ProgramOptions options;
  options.environment = {"MESA_GL_VERSION_OVERRIDE=2.1", "MESA_GLSL_VERSION_OVERRIDE=120"};
  expect_sentence(play("frames 1", {"--context", "egl"}, options), "OpenGL");
}

TEST_F(StudioProgram, SaysThatThereIsNoDisplay) {
  ProgramOptions options;
  options.environment = {"DISPLAY=", "WAYLAND_DISPLAY=", "UNDERSTUDY_CONFIG=" + scratch.path("config"),
                         "UNDERSTUDY_STATE=" + scratch.path("state")};
  expect_sentence(run_program({"studio"}, options), "display");
}

TEST_F(StudioProgram, TakesAreClipsByteForByteAsTheCommandLineMakesThem) {
  for (const char* name : {"walk", "again"}) write_scans(scratch.path(name), 6);
  write_target(scratch.path("body.obj"));
  const std::string document = scratch.path("two.understudy"), studio = scratch.path("studio.glb");
  const Finished run =
      play("open " + scratch.path("walk") + " " + scratch.path("body.obj") +
               "\nwait_value seen_takes = 1\nwait\ncompare.add 0\ntake.rename 0 walk\ntake.rename 1 again\n"
               "wait\nexport.run 0 " +
               studio + " take=again\nwait\ndocument.save_as " + document + "\n",
           {"--context", "null"});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto exported = [&](std::vector<std::string> arguments, const std::string& out) {
    arguments.insert(arguments.begin(), "export");
    arguments.insert(arguments.end(), {"--out", out});
    const Finished done = run_program(arguments);
    EXPECT_EQ(done.code, 0) << done.err;
    return read_bytes(out);
  };
  const std::string bytes = read_bytes(studio);
  ASSERT_GT(bytes.size(), 1000u);
  EXPECT_TRUE(bytes == exported({document, "--take", "walk", "--take", "2"}, scratch.path("document.glb")));
  EXPECT_TRUE(bytes == exported({"--source", scratch.path("walk"), "--source", scratch.path("again"),
                                 "--target", scratch.path("body.obj")},
                                scratch.path("sources.glb")));
  expect_sentence(run_program({"export", document, "--take", "fly", "--out", scratch.path("x.glb")}),
                  "there is no take 'fly', only 1 walk, 2 again");
}

TEST_F(StudioProgram, RecoversTheWorkAfterItWasKilled) {
  const std::string state = scratch.path("state");
  const std::string work = std::string(kWalk) +
                           "settings.autosave_s 1\nedit.drag 10 left_wrist 0 0.2 0\nwait\nframes 90\nwait\n"
                           "log all is autosaved\nframes 1\nwait_value frames >= 100000\n";
  ProgramOptions patient;
  patient.patience_s = 300;
  Program crashing({"play", script("work.us", work), "--context", "null", "--state", state}, patient);
  ASSERT_TRUE(crashing.wait_for("all is autosaved"));
  crashing.send(SIGKILL);
  EXPECT_EQ(crashing.finish().code, 128 + SIGKILL);

  const auto found = app::found_autosaves(state);
  ASSERT_EQ(found.size(), 1u);
  const Finished again = play("frames 2\nexpect_value question recover\ndocument.recover \"" + found[0].file +
                                  "\"\nwait\nexpect_value question none\nexpect_value frames 45\n"
                                  "expect_value skeleton_edits 1\nexpect_value changed yes\n"
                                  "document.save_as out/recovered.understudy\n",
                              {"--context", "null", "--state", state});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(app::read_document(scratch.path("out/recovered.understudy")).document.skeleton_edits.size(), 1u);
  const Finished clean =
      play("frames 2\nexpect_value question none\n", {"--context", "null", "--state", state});
  EXPECT_EQ(clean.code, 0) << clean.err;
}

TEST_F(StudioProgram, ARegularEndLeavesNoAutosave) {
  const Finished made =
      play(std::string(kWalk) + "frames 2\n", {"--context", "null", "--state", scratch.path("state")});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(app::found_autosaves(scratch.path("state")).empty());  // a regular end leaves none
}

TEST_F(StudioProgram, SavesPicturesAndVideo) {
  const Finished run =
      play(std::string(kWalk) +
           "playback.in 5\nplayback.out 14\npicture.save out/view.png 320 240 view\n"
           "picture.save out/clear.png 300 200 transparent view\nvideo.save out/walk.mp4 320 240 all\n"
           "video.save out/frames 160 120 view\nwait\n");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(render::read_png(scratch.path("out/view.png")).width, 320);
  EXPECT_GT(colours(render::read_png(scratch.path("out/view.png"))), 50u);
  EXPECT_TRUE(fs::exists(scratch.path("out/clear.png")));
  EXPECT_GT(fs::file_size(scratch.path("out/walk.mp4")), 2000u);
  size_t frames = 0;
  for (const auto& entry : fs::directory_iterator(scratch.path("out/frames")))
    frames += entry.is_regular_file();
  EXPECT_EQ(frames, 10u);
}

/// Names of the pictures that the tour makes.
std::vector<std::string> pictures_of_tour(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string word; lines >> word;)
    if (word == "screenshot" && lines >> word) names.push_back(word);
  return names;
}

TEST_F(StudioProgram, TheTourShowsEveryPart) {
  const std::string tour = std::string(US_SOURCE_DIR) + "/screenshots/tour.us";
  ProgramOptions patient;
  patient.patience_s = 900;
  const Finished run = run_program({"play", tour, "--out", scratch.path("tour")}, patient);
  ASSERT_EQ(run.code, 0) << run.err;
  const auto names = pictures_of_tour(read_bytes(tour));
  EXPECT_GE(names.size(), 10u);
  for (const std::string& name : names) {
    const render::Image image = render::read_png(scratch.path("tour/" + name));
    const bool small = name.find("scale_300") != std::string::npos;
    EXPECT_EQ(image.width, small ? 960 : 1080) << name;
    EXPECT_EQ(image.height, small ? 640 : 675) << name;
    EXPECT_EQ(colours(image), 100u) << name;
    EXPECT_TRUE(fs::exists(std::string(US_SOURCE_DIR) + "/screenshots/" + name)) << name;
  }
}

}  // namespace
}  // namespace understudy::tests
