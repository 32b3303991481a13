// The shipped program in a real window on a display of its own, driven by real input: Xvfb and xdotool.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/session/commands.hpp"
#include "app/session/document_file.hpp"
#include "tests/app/program.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 120;  // seconds: software OpenGL on a busy machine

/// Xvfb on a display number that it picks; ends with this object.
class Display {
 public:
  Display() {
    int ends[2];
    if (pipe(ends) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGTERM);
      const std::string to = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", to.c_str(), "-screen", "0", "1300x820x24", "-nolisten", "tcp",
             static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number_ += c;
    close(ends[0]);
  }
  ~Display() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  bool works() const { return !number_.empty(); }
  std::string name() const { return ":" + number_; }

 private:
  pid_t pid_ = -1;
  std::string number_;
};

struct Place {
  int x = 0, y = 0;
};

/// The studio's window, seen through the marks it writes and worked by xdotool.
class StudioWindow : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(display.works()) << "Xvfb does not start: Debian package xvfb";
    fs::create_directories(scratch.path("home"));
  }

  void start(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"studio", "--software", "--size", "1280x800", "--marks", marks()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ProgramOptions options;
    options.patience_s = 2 * kPatience;
    options.environment = {"DISPLAY=" + display.name(),
                           "WAYLAND_DISPLAY=",
                           "HOME=" + scratch.path("home"),
                           "UNDERSTUDY_CONFIG=" + scratch.path("config"),
                           "UNDERSTUDY_STATE=" + scratch.path("state"),
                           "LIBGL_ALWAYS_SOFTWARE=1"};
    program = std::make_unique<Program>(arguments, options);
  }

  std::string marks() const { return scratch.path("marks.txt"); }

  /// Reads what is on the screen now.
  void look() {
    facts_.clear();
    places_.clear();
    std::ifstream file(marks());
    for (std::string line; std::getline(file, line);) {
      const app::Arguments words = app::split_line(line);
      if (words.size() == 3 && words[0] == "fact") facts_[words[1]] = words[2];
      if (words.size() == 6 && words[0] == "mark")  // a disabled one has a word more
        places_[words[1]] = {static_cast<int>((std::stof(words[2]) + std::stof(words[4])) / 2),
                             static_cast<int>((std::stof(words[3]) + std::stof(words[5])) / 2)};
    }
  }

  template <class Condition>
  bool wait_until(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
    do {
      look();
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }
  std::string seen() const {
    std::string text;
    for (const auto& [key, value] : facts_) text += key + "=" + value + " ";
    for (const auto& [name, place] : places_) text += name + " ";
    return text;
  }
  void expect_fact(const std::string& key, const std::string& value) {
    ASSERT_TRUE(wait_until([&] { return facts_[key] == value; }))
        << key << " is not " << value << ": " << seen();
  }
  Place place(const std::string& name) {
    EXPECT_TRUE(wait_until([&] { return places_.count(name) > 0; })) << name << " is not there: " << seen();
    return places_[name];
  }

  void xdotool(const std::string& words) {
    const std::string line = "DISPLAY=" + display.name() + " xdotool " + words + " > /dev/null 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
  }
  static std::string at(const Place& place) {
    return std::to_string(place.x) + " " + std::to_string(place.y);
  }
  void click(const std::string& name) {
    const Place where = place(name);
    xdotool("mousemove " + at(where) + " sleep 0.1 click 1");
  }
  void drag(const Place& from, const Place& to) {
    const Place middle{(from.x + to.x) / 2, (from.y + to.y) / 2};
    xdotool("mousemove " + at(from) + " sleep 0.2 mousedown 1 sleep 0.2 mousemove " + at(middle) +
            " sleep 0.2 mousemove " + at(to) + " sleep 0.2 mouseup 1");
  }
  void key(const std::string& keys) { xdotool("key --clearmodifiers " + keys); }
  void type(const std::string& text) { xdotool("type --delay 20 '" + text + "'"); }

  Display display;
  ScratchFolder scratch;
  std::unique_ptr<Program> program;
  std::map<std::string, std::string> facts_;
  std::map<std::string, Place> places_;
};

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
