// The shipped studio in a real window on a display of its own (Xvfb), seen through the marks that it writes
// and worked by xdotool: what a person does with mouse and keys.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/app/program.hpp"
#include "tests/support/display/display.hpp"

namespace understudy::tests {

/// Pixels from the display's top left.
struct Place {
  int x = 0, y = 0;
};

/// A widget: its visible part, and whether it can be used.
struct Widget {
  float left = 0, top = 0, right = 0, bottom = 0;
  bool enabled = true;
  /// The place at these shares of its width and height.
  Place at(float across = 0.5f, float down = 0.5f) const;
};

class StudioWindow : public testing::Test {
 protected:
  static constexpr double kPatience = 120;  ///< seconds: software OpenGL on a busy machine

  void SetUp() override;
  /// Starts the studio in a window of 1280 x 800 pixels, with nothing remembered from before but that there
  /// was a before: unless `newcomer` no cards of Getting started.
  void start(std::vector<std::string> more = {});

  /// The file that the studio writes them to.
  std::string marks() const { return scratch.path("marks.txt"); }
  /// Reads what is on the screen now.
  void look();
  template <class Condition>
  bool wait_until(Condition condition) {
    return wait_until_any([&] { return static_cast<bool>(condition()); });
  }
  /// Everything that `look` found, for a failure's message.
  std::string seen() const;
  void expect_fact(const std::string& key, const std::string& value);
  Place place(const std::string& name);

  void xdotool(const std::string& words);
  static std::string at(const Place& place);
  void click(const std::string& name);
  void drag(const Place& from, const Place& to);
  /// As xdotool names keys: "ctrl+shift+z", "Return".
  void key(const std::string& keys);
  void type(const std::string& text);

  bool newcomer = false;
  Display display;
  ScratchFolder scratch;
  std::unique_ptr<Program> program;
  std::map<std::string, std::string> facts_;
  std::map<std::string, Widget> widgets_;
  std::vector<std::string> texts_;  ///< of dialogs, notices and the log

 private:
  bool wait_until_any(const std::function<bool()>& condition);
};

}  // namespace understudy::tests
