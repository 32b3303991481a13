// Records the user's input as a script that can be played again.
#pragma once

#include <fstream>
#include <string>

#include "app/studio/application.hpp"

namespace understudy::app {

/// Writes input as `event` lines, the time between as `frames`, and `wait_frames` so that a slower machine
/// makes as many frames before the input comes. Writes the resulting commands as comments.
class Recorder final : public InputListener {
 public:
  /// Writes the window's size and theme first. Throws Error when the file cannot be written.
  Recorder(const std::string& path, Application& application);
  void input(double dt, const std::vector<render::InputEvent>& events, const Session& session) override;
  void command(const std::string& name, const Arguments& arguments) override;
  /// A command without input, such as opening the files on the command line.
  void opened(const std::string& name, const Arguments& arguments);

 private:
  void write(const std::string& line);
  std::string path_;
  std::ofstream file_;
  double waited_s_ = 0;  ///< since the last line
  int made_ = 0;         ///< frames, as written last
  bool idle_ = true;
};

}  // namespace understudy::app
