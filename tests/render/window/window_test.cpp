// A real window on a display of its own: Xvfb is started for this test, xdotool makes real input.
#include "render/context/window.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "render/renderer.hpp"
#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"
#include "tests/support/display/display.hpp"

namespace understudy::render {
namespace {

/// All windows are on it.
class OnDisplay : public testing::Environment {
 public:
  void SetUp() override {
    static const tests::Display display(1400, 900);  // made before GLFW starts: it ends after GLFW
    ASSERT_TRUE(display.works()) << "Xvfb does not start: Debian package xvfb";
    setenv("DISPLAY", display.name().c_str(), 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    unsetenv("WAYLAND_DISPLAY");
  }
};
const auto* const on_display = testing::AddGlobalTestEnvironment(new OnDisplay);

struct Told {
  std::vector<InputEvent> events;
  /// Whether `matches` holds of an event; waits up to 5 s for one.
  template <class Matches>
  bool wait_for(Window& window, Matches matches) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    do {
      for (const auto& event : events)
        if (matches(event)) return true;
      window.wait(0.02);
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }
};

Window small_window(Told& told) {
  WindowOptions options;
  options.title = "Understudy test";
  options.width = 300;
  options.height = 200;
  options.debug = gl::DebugMode::Fatal;
  options.vsync = false;
  Window window(options);
  window.set_handler([&told](InputEvent event) { told.events.push_back(std::move(event)); });
  window.poll();
  return window;
}

int xdotool(const std::string& words) {
  return std::system(("xdotool " + words + " > /dev/null 2>&1").c_str());
}
const std::string kWindow = "search --sync --name 'Understudy test' ";

/// What making a window says in a process of its own with another environment. Forks, so it comes before the
/// tests that start threads.
std::string complaint_with(const char* name, const char* value) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    value == nullptr ? unsetenv(name) : setenv(name, value, 1);
    std::string words = "a window opened";
    try {
      const Window window;
    } catch (const Error& error) {
      words = error.what();
    }
    _exit(write(ends[1], words.data(), words.size()) < 0 ? 1 : 0);
  }
  close(ends[1]);
  std::string words;
  for (char c = 0; read(ends[0], &c, 1) == 1;) words += c;
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return words;
}

TEST(NoWindow, SaysThatThereIsNoDisplay) {
  EXPECT_NE(complaint_with("DISPLAY", nullptr).find("there is no display"), std::string::npos);
}

TEST(NoWindow, OffersTheSoftwareRendererWhereOpenGlIsTooOld) {
  const std::string words = complaint_with("MESA_GL_VERSION_OVERRIDE", "2.1");
  EXPECT_NE(words.find("no OpenGL 3.3"), std::string::npos) << words;
  EXPECT_NE(words.find("--software"), std::string::npos) << words;
}

TEST(Window, DrawsScenes) {
  Told told;
  Window window = small_window(told);
  EXPECT_EQ(window.size(), std::make_pair(300, 200));
  EXPECT_GT(window.content_scale(), 0);
  Scene scene;
  add(scene, make_pear());
  {
    Renderer renderer;
    renderer.draw(scene, view_of(scene, 1.5f), {0, {300, 200}});
    gl::check_debug();
    std::array<uint8_t, 3> corner{}, middle{};
    gl::api().ReadPixels(2, 195, 1, 1, GL_RGB, GL_UNSIGNED_BYTE, corner.data());
    gl::api().ReadPixels(150, 100, 1, 1, GL_RGB, GL_UNSIGNED_BYTE, middle.data());
    EXPECT_GT(corner[2], 220);  // the bright background
    EXPECT_LT(middle[2], 200);  // the pear
    window.swap();
  }
}

TEST(Window, TellsKeysTextAndModifiers) {
  Told told;
  Window window = small_window(told);
  ASSERT_EQ(xdotool(kWindow + "windowfocus key --window 0 ctrl+z"), 0);
  EXPECT_TRUE(told.wait_for(window, [](const InputEvent& e) {
    return e.kind == InputEvent::Kind::Key && e.key == Key::Z && e.pressed && e.modifiers.control;
  }));
  ASSERT_EQ(xdotool(kWindow + "windowfocus type --window 0 a"), 0);
  EXPECT_TRUE(told.wait_for(
      window, [](const InputEvent& e) { return e.kind == InputEvent::Kind::Char && e.codepoint == U'a'; }));
  ASSERT_EQ(xdotool(kWindow + "windowfocus key --window 0 F5 Page_Down"), 0);
  for (const Key key : {Key::F5, Key::PageDown})
    EXPECT_TRUE(told.wait_for(window, [key](const InputEvent& e) {
      return e.kind == InputEvent::Kind::Key && e.key == key && !e.pressed;
    })) << key_name(key);
}

TEST(Window, TellsTheMouseInPixelsFromTheTopLeft) {
  Told told;
  Window window = small_window(told);
  std::string id = "$(xdotool search --sync --name 'Understudy test')";
  ASSERT_EQ(xdotool("mousemove --window " + id + " 40 30 click 3 click 4"), 0);
  EXPECT_TRUE(told.wait_for(window, [](const InputEvent& e) {
    return e.kind == InputEvent::Kind::MouseMove && e.x == 40 && e.y == 30;
  }));
  EXPECT_TRUE(told.wait_for(window, [](const InputEvent& e) {
    return e.kind == InputEvent::Kind::MouseButton && e.button == MouseButton::Right && e.pressed &&
           e.x == 40 && e.y == 30;
  }));
  EXPECT_TRUE(told.wait_for(
      window, [](const InputEvent& e) { return e.kind == InputEvent::Kind::Scroll && e.dy > 0; }));
}

TEST(Window, TellsOfANewSize) {
  Told told;
  Window window = small_window(told);
  window.set_size(400, 250);
  EXPECT_TRUE(told.wait_for(window, [](const InputEvent& e) {
    return e.kind == InputEvent::Kind::Resize && e.width == 400 && e.height == 250 && e.scale > 0;
  }));
  EXPECT_EQ(window.size(), std::make_pair(400, 250));
}

TEST(Window, KeepsTheClipboardAndTakesEveryCursor) {
  Told told;
  Window window = small_window(told);
  window.set_clipboard("Füße");
  EXPECT_EQ(window.clipboard(), "Füße");
  for (int shape = 0; shape < static_cast<int>(CursorShape::Count); ++shape)
    window.set_cursor(static_cast<CursorShape>(shape));
  window.set_title("Understudy test, renamed");
}

TEST(Window, HandsOnWhatItsHandlerThrows) {
  Told told;
  Window window = small_window(told);
  window.set_handler([](const InputEvent&) { throw Error("handled badly"); });
  window.set_size(333, 222);
  EXPECT_THROW(
      {
        for (int i = 0; i < 200; ++i) window.wait(0.02);
      },
      Error);
}

TEST(Window, WakesFromAnotherThread) {
  Told told;
  Window window = small_window(told);
  window.wait(0.05);
  const auto begin = std::chrono::steady_clock::now();
  std::thread other([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    Window::wake();
  });
  for (int i = 0; i < 3 && std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(90); ++i)
    window.wait(20);
  other.join();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(KeyNames, AreFoundAgain) {
  for (int key = 1; key < static_cast<int>(Key::Count); ++key)
    EXPECT_EQ(key_of_name(key_name(static_cast<Key>(key))), static_cast<Key>(key)) << key;
  EXPECT_EQ(key_of_name("pageup"), Key::PageUp);
  EXPECT_EQ(key_of_name("nothing"), std::nullopt);
  EXPECT_EQ(key_name(Key::Digit7), "7");
}

}  // namespace
}  // namespace understudy::render
