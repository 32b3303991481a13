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
//   resize W H   log TEXT   type "text"   key Ctrl+Z   tab_to NAME   drop PATH...   close
//   expect NAME   expect_no NAME   expect_text TEXT   expect_value KEY [= != >= <=] VALUE   expect_error TEXT
//   event ...                             one recorded input event
// Places are pixels from the top left. A NAME is a widget's mark and stands for its middle; NAME@0.2,0.9 is
// another place in it. Paths: samples/... are the bundled samples, out/... is the folder for results; other
// relative paths are in the working folder, those of screenshot in the folder for results.
#pragma once

#include <memory>
#include <string>

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
  ~Script();

  void play(const std::string& text);
  /// Throws Error when an error dialog is open at the script's end.
  void check_no_error() const;

 private:
  struct Player;
  std::unique_ptr<Player> player_;
};

}  // namespace understudy::app
