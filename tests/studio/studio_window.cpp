#include "tests/studio/studio_window.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/session/commands.hpp"
#include "retarget/base/error.hpp"

namespace understudy::tests {
namespace {

std::string quoted(const std::string& text) {
  std::string shell = "'";
  for (const char c : text) shell += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return shell + "'";
}

}  // namespace

Place Widget::at(float across, float down) const {
  return {static_cast<int>(left + across * (right - left)), static_cast<int>(top + down * (bottom - top))};
}

void StudioWindow::SetUp() {
  ASSERT_TRUE(display.works()) << "Xvfb does not start: Debian package xvfb";
  std::filesystem::create_directories(scratch.path("home"));
}

void StudioWindow::start(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"studio", "--software", "--size", "1280x800", "--marks", marks()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const std::filesystem::path settings = scratch.path("config/settings.json");
  std::filesystem::create_directories(settings.parent_path());
  if (!newcomer && !std::filesystem::exists(settings)) std::ofstream(settings) << "{}";
  ProgramOptions options;
  options.patience_s = 5 * kPatience;
  options.environment = {"DISPLAY=" + display.name(),
                         "WAYLAND_DISPLAY=",
                         "HOME=" + scratch.path("home"),
                         "UNDERSTUDY_CONFIG=" + scratch.path("config"),
                         "UNDERSTUDY_STATE=" + scratch.path("state"),
                         "LIBGL_ALWAYS_SOFTWARE=1"};
  program = std::make_unique<Program>(arguments, options);
  ASSERT_TRUE(wait_until([&] { return !widgets_.empty(); })) << "nothing is drawn";
  xdotool("mousemove 640 400 sleep 0.3");  // without a window manager keys go where the pointer is
}

void StudioWindow::look() {
  facts_.clear();
  widgets_.clear();
  texts_.clear();
  std::ifstream file(marks());
  for (std::string line; std::getline(file, line);) {
    const app::Arguments words = app::split_line(line);
    if (words.size() == 3 && words[0] == "fact") facts_[words[1]] = words[2];
    if (words.size() == 2 && words[0] == "text") texts_.push_back(words[1]);
    if (words.size() >= 6 && words[0] == "mark")  // a disabled one has a word more
      widgets_[words[1]] = {std::stof(words[2]), std::stof(words[3]), std::stof(words[4]),
                            std::stof(words[5]), words.size() == 6};
  }
}

bool StudioWindow::wait_until_any(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
  do {
    look();
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

std::string StudioWindow::seen() const {
  std::string text;
  for (const auto& [key, value] : facts_) text += key + "=" + value + " ";
  for (const auto& [name, widget] : widgets_) text += name + (widget.enabled ? " " : " (disabled) ");
  for (const std::string& line : texts_) text += "\n" + line;
  return text;
}

void StudioWindow::expect_fact(const std::string& key, const std::string& value) {
  ASSERT_TRUE(wait_until([&] { return facts_[key] == value; }))
      << key << " is not " << value << ": " << seen();
}

Place StudioWindow::place(const std::string& name) {
  EXPECT_TRUE(wait_until([&] { return widgets_.count(name) > 0 && widgets_[name].enabled; }))
      << name << " is not there, or disabled: " << seen();
  Place before, now = widgets_[name].at();
  do {  // a click may have moved it
    before = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    look();
    if (widgets_.count(name) > 0) now = widgets_[name].at();
  } while (now.x != before.x || now.y != before.y);
  return now;
}

void StudioWindow::xdotool(const std::string& words) {
  const std::string line = "DISPLAY=" + display.name() + " xdotool " + words + " > /dev/null 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << line;
}

std::string StudioWindow::at(const Place& place) {
  return std::to_string(place.x) + " " + std::to_string(place.y);
}

void StudioWindow::click(const std::string& name) {
  const Place where = place(name);
  xdotool("mousemove " + at(where) + " sleep 0.1 click 1");
}

void StudioWindow::drag(const Place& from, const Place& to) {
  const Place middle{(from.x + to.x) / 2, (from.y + to.y) / 2};
  xdotool("mousemove " + at(from) + " sleep 0.2 mousedown 1 sleep 0.2 mousemove " + at(middle) +
          " sleep 0.2 mousemove " + at(to) + " sleep 0.2 mouseup 1");
}

void StudioWindow::key(const std::string& keys) {
  xdotool("key --clearmodifiers " + keys);
}

void StudioWindow::type(const std::string& text) {
  xdotool("type --delay 20 " + quoted(text));
}

}  // namespace understudy::tests
