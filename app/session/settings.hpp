// The user's settings between runs, as JSON in the user's configuration folder.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"

namespace understudy::app {

/// Cards of Getting started: open, look, fix, compare, export.
constexpr int kGettingStartedCards = 5;

struct Settings {
  bool dark = true;
  float scale = 0;                  ///< of the interface; 0: the screen's own; 0.75 .. 3
  int samples = 4;                  ///< of antialiasing a pixel: 1, 2, 4
  float mouse_sensitivity = 1;      ///< 0.2 .. 4
  double autosave_s = 20;           ///< 5 .. 600
  int cache_mb = 512;               ///< memory for frames shown, 64 .. 8192
  int undo_depth = 200;             ///< 10 .. 1000
  std::vector<std::string> recent;  ///< documents, the newest first, 12 at most
  std::vector<std::string> recent_sources, recent_targets;  ///< of sources see recent_source
  std::vector<std::string> recent_studies;
  std::map<std::string, bool> panels;  ///< shown or not, by name; missing: as the window has it
  std::string last_folder;    ///< that something was opened from or saved in: where the browser starts
  std::string export_format;  ///< the last one used, by name; "csv": figures; empty: none yet
  std::string send_to = "vmc://127.0.0.1:39539";  ///< where poses go, see PoseSender
  int getting_started = 0;                        ///< the card that is shown, from 1; 0: none
  int window_width = 1280, window_height = 800;
};
template <class V, class S>
FieldsOf<S, Settings> fields(V& visit, S& settings) {
  visit("dark", settings.dark);
  visit("scale", settings.scale, Clamped<float>{0.75f, 3});
  visit("mouse_sensitivity", settings.mouse_sensitivity, Clamped<float>{0.2f, 4});
  visit("autosave_s", settings.autosave_s, Clamped<double>{5, 600});
  visit("samples", settings.samples, Clamped<int>{1, 4});
  visit("cache_mb", settings.cache_mb, Clamped<int>{64, 8192});
  visit("undo_depth", settings.undo_depth, Clamped<int>{10, 1000});
  visit("window_width", settings.window_width, Clamped<int>{400, 16384});
  visit("window_height", settings.window_height, Clamped<int>{300, 16384});
  visit("recent", settings.recent);
  visit("recent_sources", settings.recent_sources);
  visit("recent_targets", settings.recent_targets);
  visit("recent_studies", settings.recent_studies);
  visit("panels", settings.panels);
  visit("last_folder", settings.last_folder);
  visit("export_format", settings.export_format);
  visit("send_to", settings.send_to);
  visit("getting_started", settings.getting_started, Clamped<int>{0, kGettingStartedCards});
}

/// $XDG_CONFIG_HOME/understudy or ~/.config/understudy; UNDERSTUDY_CONFIG overrides it.
std::string config_folder();
/// $XDG_STATE_HOME/understudy or ~/.local/state/understudy; UNDERSTUDY_STATE overrides it.
std::string state_folder();

/// Clamps values that are out of range; a missing value, or one of another type, stays the default. A file
/// that is not JSON gives the defaults and a warning.
Settings read_settings(const std::string& path);
/// Writes beside the file, then renames. Throws Error naming the path.
void write_settings(const std::string& path, const Settings& settings);
/// A source, or a body and the motion that it performs, as one entry of recent sources; and an entry's paths.
std::string recent_source(const std::string& path, const std::string& motion);
std::vector<std::string> paths_of_recent(const std::string& entry);
/// Puts `path` first in a recent list.
void remember(std::vector<std::string>& recent, std::string path);
/// Takes what cannot be opened off recent lists. How the sentence that says why goes on:
/// "" where it is in none.
std::string taken_off(std::initializer_list<std::vector<std::string>*> lists, const std::string& entry);

}  // namespace understudy::app
