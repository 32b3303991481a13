// The paths of a person (paths/*.us) with mouse and keys through the real window. They are scripts of
// `understudy play` without its commands: what a person has no widget or key for cannot be played.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "app/session/commands.hpp"
#include "app/studio/event_text.hpp"
#include "app/studio/facts.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/sample_files.hpp"
#include "tests/retarget/scene/made_scene.hpp"
#include "tests/studio/studio_window.hpp"
#include "ui/gui/key_chord.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;
using Words = app::Arguments;

/// A key as X names it: "Return" for "Enter".
std::string x_key(render::Key key) {
  static const std::map<std::string, std::string> kOthers = {
      {"Enter", "Return"},
      {"Backspace", "BackSpace"},
      {"PageUp", "Prior"},
      {"PageDown", "Next"},
      {"Space", "space"},
      {"Apostrophe", "apostrophe"},
      {"Comma", "comma"},
      {"Minus", "minus"},
      {"Period", "period"},
      {"Slash", "slash"},
      {"Equal", "equal"},
      {"LeftBracket", "bracketleft"},
      {"RightBracket", "bracketright"},
      {"LeftControl", "ctrl"},
      {"LeftShift", "shift"},
      {"LeftAlt", "alt"},
      {"LeftSuper", "super"},
  };
  const std::string name(render::key_name(key));
  const auto found = kOthers.find(name);
  if (found != kOthers.end()) return found->second;
  return name.size() == 1 ? lower_case(name) : name;
}

/// One scan of another animal: the sample's, smaller and on longer legs for its size.
void write_pony(const std::string& path) {
  const Mesh animal = read_mesh(US_SOURCE_DIR "/assets/samples/animal/frame_00010.ply");
  write_cloud(path, animal.vertices * Vec3(0.6f, 0.75f, 0.6f).asDiagonal());
}

bool is_number(const std::string& text) {
  double value = 0;
  return parse_number(text, value);
}

/// Two people, 1.5 m apart, dance on a ground, 16 frames.
void write_people(const std::string& file) {
  if (fs::exists(file)) return;
  test::Actor left, right;
  left.place = {-0.75f, 0, 0}, right.place = {0.75f, 0, -0.2f};
  left.motion = right.motion = "dance", right.first = 20, right.stature = 1.62f;
  test::MadeScene scene({left, right});
  scene.add_ground(1.8f, 5000);
  NpyArray points;
  for (int t = 0; t < 16; ++t) {
    const Points frame = scene.frame(t).scan.vertices;
    points.shape = {t + 1, frame.rows(), 3};
    points.values.insert(points.values.end(), frame.data(), frame.data() + frame.size());
  }
  write_npz(file, {{"points", points}});
}

/// The sample's first 30 scans, but for 12 to 16.
void copy_with_a_gap(const std::string& folder) {
  fs::create_directories(folder);
  for (int t = 0; t < 30; ++t) {
    const std::string name = printed("frame_%05d.ply", t);
    if (t < 12 || t > 16)
      fs::copy_file(US_SOURCE_DIR "/assets/samples/scan/" + name, folder + "/" + name,
                    fs::copy_options::overwrite_existing);
  }
}

/// Three recordings of one motion.
void write_recordings(const std::string& folder, const std::string& motion) {
  fs::create_directories(folder);
  for (int i = 0; i < 3; ++i) {
    WalkOptions part;
    part.motion = motion, part.first = 20 * i, part.last = 90 + 20 * i;
    write_walk(folder + "/" + std::to_string(i) + ".npz", part);
  }
}

class Path : public StudioWindow, public testing::WithParamInterface<std::string> {
 protected:
  using Play = void (Path::*)(const Words&);

  void play_file(const fs::path& file) {
    std::ifstream lines(file);
    int number = 0;
    for (std::string line; std::getline(lines, line) && !HasFailure();) {
      ++number;
      const testing::ScopedTrace trace(file.c_str(), number, line);
      const Words words = app::split_line(line);
      if (!words.empty()) play_line(words);
    }
  }

  void play_line(const Words& words) {
    static const std::map<std::string, Play> rows = {
        {"click", &Path::click_left},
        {"right_click", &Path::click_right},
        {"double_click", &Path::click_twice},
        {"hover", &Path::hover},
        {"drag", &Path::drag_by},
        {"drag_to", &Path::drag_onto},
        {"scroll", &Path::scroll},
        {"type", &Path::type_text},
        {"key", &Path::press_key},
        {"tab_to", &Path::tab_to},
        {"resize", &Path::resize},
        {"wait", &Path::wait},
        {"frames", &Path::frames},
        {"wait_value", &Path::expect_value},
        {"expect_value", &Path::expect_value},
        {"expect", &Path::expect},
        {"expect_no", &Path::expect_no},
        {"expect_text", &Path::expect_text},
        {"expect_file", &Path::expect_file},
        {"screenshot", &Path::screenshot},
        {"restart", &Path::restart},
        {"kill", &Path::kill_it},
        {"first_start", &Path::first_start},
    };
    const auto row = rows.find(words[0]);
    ASSERT_NE(row, rows.end()) << words[0] << " is nothing that a person does";
    (this->*row->second)(words);
  }

  // Doing.

  /// NAME, NAME@0.2,0.9, or X Y.
  Place place_of(const Words& words, size_t at = 1) {
    if (is_number(words.at(at))) return {std::stoi(words[at]), std::stoi(words.at(at + 1))};
    const size_t share = words[at].find('@');
    const std::string name = words[at].substr(0, share);
    const Place middle = place(name);
    if (share == std::string::npos) return middle;
    const auto shares = words[at].substr(share + 1);
    const size_t comma = shares.find(',');
    return widgets_[name].at(std::stof(shares.substr(0, comma)), std::stof(shares.substr(comma + 1)));
  }

  /// "keydown ctrl " of the keys that end the line, or keyup.
  static std::string modifiers(const Words& words, const std::string& action) {
    std::string all;
    for (size_t i = words.size(); i > 1; --i) {
      if (words[i - 1] != "ctrl" && words[i - 1] != "shift" && words[i - 1] != "alt") break;
      all += action + " " + words[i - 1] + " ";
    }
    return all;
  }
  /// The keys that end the line are held while `action` is done.
  void held(const Words& words, const std::string& action) {
    xdotool(modifiers(words, "keydown") + action + " " + modifiers(words, "keyup"));
  }

  void press(const Words& words, const std::string& button) {
    held(words, "mousemove " + at(place_of(words)) + " sleep 0.1 click " + button);
  }
  void click_left(const Words& words) { press(words, "1"); }
  void click_right(const Words& words) { press(words, "3"); }
  void click_twice(const Words& words) { press(words, "--repeat 2 --delay 60 1"); }

  void hover(const Words& words) {
    xdotool("mousemove " + at(place_of(words)) + " sleep 1.2");  // until a tooltip shows
  }

  void drag_between(const Words& words, const Place& from, const Place& to) {
    // Each step waits until the studio has drawn it: a busy machine takes its time.
    const auto step = [&](const std::string& action, const std::string& pointer) {
      xdotool(action);
      ASSERT_TRUE(wait_until([&] { return facts_["pointer"] == pointer; }))
          << pointer << " is not seen: " << seen();
    };
    step(modifiers(words, "keydown") + "mousemove " + at(from), at(from));
    frames({"frames", "12"});
    step("mousedown 1", at(from) + " down");
    constexpr int kSteps = 5;
    for (int i = 1; i <= kSteps; ++i) {
      const Place way{from.x + i * (to.x - from.x) / kSteps, from.y + i * (to.y - from.y) / kSteps};
      step("mousemove " + at(way), at(way) + " down");
    }
    step("mouseup 1 " + modifiers(words, "keyup"), at(to));
  }
  /// NAME DX DY, or X Y X2 Y2.
  void drag_by(const Words& words) {
    const Place from = place_of(words);
    if (is_number(words[1])) return drag_between(words, from, place_of(words, 3));
    drag_between(words, from, {from.x + std::stoi(words.at(2)), from.y + std::stoi(words.at(3))});
  }
  void drag_onto(const Words& words) {
    const Place from = place_of(words);
    drag_between(words, from, place_of(words, 2));
  }

  void scroll(const Words& words) {
    const size_t notches = is_number(words.at(1)) ? 3 : 2;
    const int turns = std::stoi(words.at(notches));
    held(words, "mousemove " + at(place_of(words)) + " sleep 0.1 click --repeat " +
                    std::to_string(std::abs(turns)) + " --delay 60 " + (turns > 0 ? "4" : "5"));
  }

  void type_text(const Words& words) { type(path_of(words.at(1))); }

  void press_key(const Words& words) {
    const auto chord = ui::chord_of(words.at(1));
    ASSERT_TRUE(chord) << words[1] << " is not a key";
    std::string keys;
    for (const ui::Modifier& modifier : ui::kModifiers)
      if (chord->modifiers.*modifier.held) keys += std::string(modifier.name) + "+";
    key(keys + x_key(chord->key));
  }

  void tab_to(const Words& words) {
    look();
    for (int i = 0; i < 100 && facts_["focus"] != words.at(1); ++i) {
      key("Tab");
      frames({"frames", "12"});
      look();
    }
    ASSERT_EQ(facts_["focus"], words.at(1)) << seen();
  }

  void resize(const Words& words) {
    xdotool("search --onlyvisible --name Understudy windowsize --sync %1 " + words.at(1) + " " + words.at(2));
  }

  /// The studio was closed: starts it again, with what it remembers.
  void restart(const Words&) {
    ASSERT_EQ(program->finish().code, 0);
    start_again();
  }
  /// As a crash or a power cut ends it once all that was done is in a copy; then starts it again.
  void kill_it(const Words&) {
    const auto now = fs::file_time_type::clock::now();
    ASSERT_TRUE(wait_until([&] { return copied_since(now); })) << "no copy of unsaved work: " << seen();
    program->send(SIGKILL);
    program->finish();
    start_again();
  }
  /// Somebody else's first start: nothing is remembered.
  void first_start(const Words&) {
    program->send(SIGKILL);
    program->finish();
    for (const char* folder : {"config", "state"}) fs::remove_all(scratch.path(folder));
    newcomer = true;
    start_again();
  }
  /// Whether unsaved work was written for recovery after `moment`.
  bool copied_since(fs::file_time_type moment) const {
    const fs::path folder = scratch.path("state");
    if (!fs::exists(folder)) return false;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".understudy" && entry.last_write_time() > moment) return true;
    return false;
  }
  void start_again() {
    fs::remove(marks());
    start();
  }

  // Waiting and looking.

  void wait(const Words&) {
    const auto idle = [&] {
      return facts_["working"] == "no" && facts_["jobs"] == "0" && facts_["ready_takes"] == facts_["takes"];
    };
    ASSERT_TRUE(wait_until(idle)) << seen();
    frames({"frames", "20"});  // a click's work begins with the next frame
    ASSERT_TRUE(wait_until(idle)) << seen();
  }

  void frames(const Words& words) {
    std::this_thread::sleep_for(std::chrono::milliseconds(std::stoi(words.at(1)) * 1000 / 60));
  }

  void expect_value(const Words& words) {
    const bool compared = words.size() == 4;
    const std::string key = words.at(1), sign = compared ? words[2] : "=", value = words.at(compared ? 3 : 2);
    ASSERT_TRUE(wait_until([&] {
      return facts_.count(key) > 0 && app::holds(facts_[key], sign, path_of(value));
    })) << key
        << " is " << facts_[key] << ": " << seen();
  }

  /// Whether the condition comes true, and stays so: what flashes up for a frame was not shown.
  template <class Condition>
  bool comes_and_stays(Condition condition) {
    if (!wait_until(condition)) return false;
    frames({"frames", "20"});
    look();
    return condition();
  }
  void expect(const Words& words) {
    ASSERT_TRUE(comes_and_stays([&] { return widgets_.count(words.at(1)) > 0; })) << seen();
  }
  void expect_no(const Words& words) {
    ASSERT_TRUE(comes_and_stays([&] { return widgets_.count(words.at(1)) == 0; })) << seen();
  }

  void expect_text(const Words& words) {
    const auto shown = [&] {
      for (const std::string& text : texts_)
        if (text.find(words.at(1)) != std::string::npos) return true;
      return false;
    };
    ASSERT_TRUE(wait_until(shown)) << words[1] << ": " << seen();
  }

  void expect_file(const Words& words) {
    const std::string path = path_of(words.at(1));
    ASSERT_TRUE(wait_until([&] { return fs::exists(path) && facts_["jobs"] == "0"; }))
        << path << ": " << seen();
  }

  /// For a person to look at, in build/paths.
  void screenshot(const Words& words) {
    frames({"frames", "30"});
    const render::Image image = display.picture();
    std::set<std::array<uint8_t, 3>> colours;
    for (size_t i = 0; i + 2 < image.pixels.size(); i += 3)
      colours.insert({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
    EXPECT_GT(colours.size(), 50u) << "an empty window";
    const fs::path folder = fs::path(US_PROGRAM).parent_path() / "paths";
    fs::create_directories(folder);
    render::write_png((folder / words.at(1)).string(), image);
  }

  std::string path_of(const std::string& word) const {
    if (word == "out/people.npz") write_people(scratch.path("people.npz"));
    if (word == "out/walk.npz") write_walk(scratch.path("walk.npz"));
    if (word == "out/run.npz") write_walk(scratch.path("run.npz"), {"walk", 48});
    if (word == "out/motions") {
      fs::create_directories(scratch.path("motions"));
      write_walk(scratch.path("motions/walk.npz")), write_walk(scratch.path("motions/run.npz"), {"walk", 48});
    }
    if (word == "out/walks") write_recordings(scratch.path("walks"), "walk");
    if (word == "out/dances") write_recordings(scratch.path("dances"), "dance");
    if (word == "out/pony.ply") write_pony(scratch.path("pony.ply"));
    if (word == "out/gaps") copy_with_a_gap(scratch.path("gaps"));
    if (starts_with(word, "samples/")) return std::string(US_SOURCE_DIR "/assets/") + word;
    return starts_with(word, "out/") ? scratch.path(word.substr(4)) : word;
  }
};

std::vector<std::string> paths() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(US_SOURCE_DIR "/tests/studio/paths"))
    if (entry.path().extension() == ".us") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST_P(Path, IsWalked) {
  start();
  play_file(US_SOURCE_DIR "/tests/studio/paths/" + GetParam() + ".us");
  look();
  EXPECT_EQ(facts_["errors"], "0") << seen();
  if (HasFailure()) screenshot({"screenshot", GetParam() + "_failed.png"});
}

INSTANTIATE_TEST_SUITE_P(Studio, Path, testing::ValuesIn(paths()),
                         [](const testing::TestParamInfo<std::string>& path) { return path.param; });

}  // namespace
}  // namespace understudy::tests
