#include "app/session/settings.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostRecent = 12;
constexpr int64_t kLargestFile = 1 << 20;

/// One figure: its key, where it is kept, and its range. Defaults are Settings' own.
template <class Number>
struct Figure {
  const char* key;
  Number Settings::*member;
  Number low, high;
};
constexpr Figure<float> kFloats[] = {{"scale", &Settings::scale, 0.75f, 3},
                                     {"mouse_sensitivity", &Settings::mouse_sensitivity, 0.2f, 4}};
constexpr Figure<double> kDoubles[] = {{"autosave_s", &Settings::autosave_s, 5, 600}};
constexpr Figure<int> kInts[] = {{"samples", &Settings::samples, 1, 4},
                                 {"cache_mb", &Settings::cache_mb, 64, 8192},
                                 {"undo_depth", &Settings::undo_depth, 10, 1000},
                                 {"window_width", &Settings::window_width, 400, 16384},
                                 {"window_height", &Settings::window_height, 300, 16384}};

struct List {
  const char* key;
  std::vector<std::string> Settings::*member;
};
constexpr List kLists[] = {{"recent", &Settings::recent},
                           {"recent_sources", &Settings::recent_sources},
                           {"recent_targets", &Settings::recent_targets}};

template <class Visit>
void for_each_figure(Visit visit) {
  for (const auto& figure : kFloats) visit(figure);
  for (const auto& figure : kDoubles) visit(figure);
  for (const auto& figure : kInts) visit(figure);
}

void bring_into_range(Settings& settings) {
  const bool scale_by_screen = !(settings.scale > 0);
  const Settings defaults;
  for_each_figure([&](const auto& figure) {
    auto& value = settings.*figure.member;
    if (std::isnan(static_cast<double>(value))) value = defaults.*figure.member;
    value = std::clamp(value, figure.low, figure.high);
  });
  if (scale_by_screen) settings.scale = 0;
  if (settings.samples == 3) settings.samples = 2;
  for (const List& list : kLists)
    if ((settings.*list.member).size() > kMostRecent) (settings.*list.member).resize(kMostRecent);
}

template <class Number>
void read_figure(const Json& json, const Figure<Number>& figure, Settings& settings) {
  const auto found = json.find(figure.key);
  if (found == json.end() || !found->is_number()) return;
  // Far outside first: what a Number cannot hold must not be converted to it.
  const double value = std::clamp(found->template get<double>(), -1e9, 1e9);
  settings.*figure.member = static_cast<Number>(value);
}

void read_bool(const Json& json, const char* key, bool& value) {
  const auto found = json.find(key);
  if (found != json.end() && found->is_boolean()) value = found->get<bool>();
}

Settings from_json(const Json& json) {
  Settings settings;
  for_each_figure([&](const auto& figure) { read_figure(json, figure, settings); });
  read_bool(json, "dark", settings.dark);
  for (const List& list : kLists) {
    const auto found = json.find(list.key);
    if (found == json.end() || !found->is_array()) continue;
    for (const Json& path : *found)
      if (path.is_string()) (settings.*list.member).push_back(path.get<std::string>());
  }
  const auto panels = json.find("panels");
  if (panels != json.end() && panels->is_object())
    for (const auto& panel : panels->items())
      if (panel.value().is_boolean()) settings.panels[panel.key()] = panel.value().get<bool>();
  const auto folder = json.find("last_folder");
  if (folder != json.end() && folder->is_string()) settings.last_folder = folder->get<std::string>();
  bring_into_range(settings);
  return settings;
}

/// A folder by the XDG rules: relative paths in the environment do not count.
std::string user_folder(const char* own, const char* xdg, const char* below_home) {
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value ? value : "";
  };
  if (const fs::path path = variable(own); !path.empty()) return path.string();
  if (const fs::path path = variable(xdg); path.is_absolute()) return (path / "understudy").string();
  if (const fs::path home = variable("HOME"); !home.empty())
    return (home / below_home / "understudy").string();
  return (fs::temp_directory_path() / ("understudy-" + std::to_string(getuid()))).string();
}

}  // namespace

std::string config_folder() {
  return user_folder("UNDERSTUDY_CONFIG", "XDG_CONFIG_HOME", ".config");
}

std::string state_folder() {
  return user_folder("UNDERSTUDY_STATE", "XDG_STATE_HOME", ".local/state");
}

Settings read_settings(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};  // the first run
  try {
    const Json json = Json::parse(read_file(path, kLargestFile), nullptr, /*allow_exceptions=*/false);
    US_CHECK(json.is_object(), path, ": holds no settings");
    return from_json(json);
  } catch (const Error& error) {
    log::warn(std::string(error.what()) + "; the settings are back to their defaults");
  }
  return {};
}

void write_settings(const std::string& path, const Settings& settings) {
  Settings kept = settings;
  bring_into_range(kept);
  Json json{{"dark", kept.dark}};
  for_each_figure([&](const auto& figure) { json[figure.key] = kept.*figure.member; });
  for (const List& list : kLists) json[list.key] = kept.*list.member;
  json["panels"] = kept.panels;
  json["last_folder"] = kept.last_folder;
  std::error_code ignored;  // what is wrong with the folder, the writing says
  fs::create_directories(fs::path(path).parent_path(), ignored);
  write_file(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

void remember(std::vector<std::string>& recent, const std::string& path) {
  if (path.empty()) return;
  const std::string kept = path;  // it may be in the list itself
  recent.erase(std::remove(recent.begin(), recent.end(), kept), recent.end());
  recent.insert(recent.begin(), kept);
  if (recent.size() > kMostRecent) recent.resize(kMostRecent);
}

}  // namespace understudy::app
