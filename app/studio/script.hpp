// Scripts: named commands and a user's input, line by line; for pictures, tests, recordings and bug reports.
//
// Every command of the registry by its name, and:
//   wait [SECONDS]                        until everything is made and shown
//   wait_frames N                         until N frames are made
//   wait_value KEY [= != >= <=] VALUE     until the fact holds
//   frames N                              draws N frames of 1/60 s
//   screenshot FILE.png [WxH]             the whole window
//   click NAME | X Y                      also double_click, right_click, hover; options: ctrl shift alt
//   drag NAME DX DY | X Y X2 Y2   drag_to NAME NAME2   scroll NAME | X Y  NOTCHES     the same options
//   resize W H   log TEXT   type "text"   key Ctrl+Z   drop PATH...   close
//   expect NAME   expect_no NAME   expect_text TEXT   expect_value KEY [= != >= <=] VALUE   expect_error TEXT
//   event ...                             one recorded input event
// Places are pixels from the top left. A NAME is a widget's mark and stands for its middle; NAME@0.2,0.9 is
// another place in it. Paths: samples/... are the bundled samples, out/... is the folder for results; other
// relative paths are in the working folder, those of screenshot in the folder for results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/studio/application.hpp"

namespace understudy::app {

struct ScriptOptions {
  std::string name = "script";  ///< for error messages: "tour.us"
  std::string out = ".";        ///< folder for results, made when needed
  double timeout_s = 600;       ///< of each wait
};

/// Plays scripts on an application without a window. Throws Error "NAME:LINE: what is wrong".
class Script {
 public:
  /// `surface` is the application's.
  Script(Application& application, OffscreenSurface& surface, ScriptOptions options = {});

  void play(const std::string& text);
  /// Runs one line; empty lines and comments do nothing.
  void play_line(const std::string& line);
  /// Throws Error when an error dialog is open at the script's end.
  void check_no_error() const;

 private:
  using Words = Arguments;
  struct Row {
    const char* name;
    size_t least, most;
    void (Script::*play)(const Words&);
  };
  static const std::vector<Row>& rows();

  void wait(const Words& words);
  void wait_frames(const Words& words);
  void wait_value(const Words& words);
  void frames(const Words& words);
  void screenshot(const Words& words);
  void resize(const Words& words);
  void log(const Words& words);
  void click(const Words& words);
  void double_click(const Words& words);
  void right_click(const Words& words);
  void hover(const Words& words);
  void drag(const Words& words);
  void drag_to(const Words& words);
  void scroll(const Words& words);
  void type(const Words& words);
  void key(const Words& words);
  void drop(const Words& words);
  void close(const Words& words);
  void expect(const Words& words);
  void expect_no(const Words& words);
  void expect_text(const Words& words);
  void expect_value(const Words& words);
  void expect_error(const Words& words);
  void event(const Words& words);

  struct Pointing;
  Pointing pointing(Words words, size_t places) const;
  ImVec2 place_of(const std::string& name);
  void press(const Pointing& pointing, render::MouseButton button, int times);
  void drag_between(ImVec2 from, ImVec2 to, render::Modifiers modifiers);
  void send(std::vector<render::InputEvent> events);
  void draw(int count = 1);
  void settle();
  void until(const std::function<bool()>& done, const std::string& what, double timeout_s);
  std::string path_of(const std::string& argument) const;

  Application& application_;
  OffscreenSurface& surface_;
  ScriptOptions options_;
};

}  // namespace understudy::app
