// An interface without GL, a window or a clock: what every test of widgets and panels stands on.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "ui/gui/gui.hpp"

namespace understudy::ui {

/// Draws `content` frame by frame (60 a second) and plays input at it. `content` draws whole windows, or set
/// it with in_window().
class UiTest : public testing::Test {
 protected:
  std::function<void(Ui&)> content = [](Ui&) {};
  FrameInput input{{800, 600}};
  Gui gui;

  /// Wraps what draws widgets into one window that covers the display.
  void in_window(std::function<void(Ui&)> widgets);

  /// One frame, or several, without input.
  const ImDrawData& frame(int count = 1);
  /// Queues the events and draws until they have all been seen, and one frame more.
  void play(std::vector<render::InputEvent> events);

  // By name of a mark (a failure when it is not to be seen or greyed out) or by place in pixels.
  void click(const std::string& name, render::MouseButton button = render::MouseButton::Left);
  void click(ImVec2 at, render::MouseButton button = render::MouseButton::Left,
             render::Modifiers modifiers = {});
  void double_click(const std::string& name);
  /// Moves there and rests until a tooltip would show.
  void hover(const std::string& name, float x = 0.5f, float y = 0.5f);
  /// Presses at one share of the mark's width, moves to another, releases.
  void drag(const std::string& name, float from, float to);
  void drag(ImVec2 from, ImVec2 to, render::Modifiers modifiers = {},
            render::MouseButton button = render::MouseButton::Left);
  void scroll(const std::string& name, float notches, render::Modifiers modifiers = {});
  void type(const std::string& text);
  void key(render::Key key, render::Modifiers modifiers = {});

  /// The mark; a failure and a place outside the display when there is none.
  Mark mark(const std::string& name);
  bool shown(const std::string& name);
};

}  // namespace understudy::ui
