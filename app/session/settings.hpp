// The user's settings between runs, as JSON in the user's configuration folder.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace understudy::app {

struct Settings {
  bool dark = true;
  float scale = 0;                  ///< of the interface; 0: as the screen says; 0.75 .. 3
  int samples = 4;                  ///< of antialiasing a pixel: 1, 2, 4
  float mouse_sensitivity = 1;      ///< 0.2 .. 4
  double autosave_s = 20;           ///< 5 .. 600
  int cache_mb = 512;               ///< memory for frames looked at, 64 .. 8192
  int undo_depth = 200;             ///< 10 .. 1000
  std::vector<std::string> recent;  ///< documents, the newest first, 12 at most
  std::vector<std::string> recent_sources, recent_targets;
  std::map<std::string, bool> panels;  ///< shown or not, by name; missing: shown
  std::string last_folder;             ///< of the file browser
  int window_width = 1280, window_height = 800;
};

/// $XDG_CONFIG_HOME/understudy or ~/.config/understudy; UNDERSTUDY_CONFIG overrides it.
std::string config_folder();
/// $XDG_STATE_HOME/understudy or ~/.local/state/understudy; UNDERSTUDY_STATE overrides it.
std::string state_folder();

/// Clamps values that are out of range; a missing value, or one of another type, stays the default. A file
/// that is not JSON gives the defaults and a warning.
Settings read_settings(const std::string& path);
/// Writes beside the file, then renames. Throws Error naming the path.
void write_settings(const std::string& path, const Settings& settings);
/// Puts `path` first in a recent list.
void remember(std::vector<std::string>& recent, const std::string& path);

}  // namespace understudy::app
