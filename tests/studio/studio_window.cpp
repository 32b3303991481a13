#include "tests/studio/studio_window.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/session/commands.hpp"
#include "retarget/base/error.hpp"

namespace understudy::tests {
namespace {

/// The 32-bit number at `at` of a header of xwd, which is big-endian.
uint32_t header_number(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

std::string quoted(const std::string& text) {
  std::string shell = "'";
  for (const char c : text) shell += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return shell + "'";
}

}  // namespace

Display::Display() {
  int ends[2];
  if (pipe(ends) != 0) return;
  const std::string folder = memory_.path(".");
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    const std::string to = std::to_string(ends[1]);
    execlp("Xvfb", "Xvfb", "-displayfd", to.c_str(), "-screen", "0", "1300x820x24", "-fbdir", folder.c_str(),
           "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number_ += c;
  close(ends[0]);
}

Display::~Display() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

render::Image Display::picture() const {
  const std::string bytes =
      read_bytes(memory_.path("Xvfb_screen0"));  // as xwd writes: header, colours, pixels
  US_CHECK(bytes.size() > 100, memory_.path("Xvfb_screen0"), ": the display cannot be read");
  const size_t header = header_number(bytes, 0), row = header_number(bytes, 48);
  const size_t pixels = header + 12 * static_cast<size_t>(header_number(bytes, 76));
  render::Image image;
  image.width = static_cast<int>(header_number(bytes, 16));
  image.height = static_cast<int>(header_number(bytes, 20));
  US_CHECK(bytes.size() >= pixels + row * static_cast<size_t>(image.height), "the display's picture is cut");
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const size_t from = pixels + static_cast<size_t>(y) * row + 4 * static_cast<size_t>(x);  // B G R -
      for (const size_t channel : {2, 1, 0})
        image.pixels.push_back(static_cast<unsigned char>(bytes[from + channel]));
    }
  return image;
}

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
