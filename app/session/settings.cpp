#include "app/session/settings.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "app/run/fields_json.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/live/pose_sender.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostRecent = 12;
constexpr int64_t kLargestFile = 1 << 20;

void bring_into_range(Settings& settings) {
  const bool scale_by_screen = !(settings.scale > 0);
  const auto bring_in = [](const char*, auto& value, const auto&... rule) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (sizeof...(rule) > 0)
      value = std::clamp(value, rule.low..., rule.high...);
    else if constexpr (std::is_same_v<Value, std::vector<std::string>>)
      value.resize(std::min(value.size(), kMostRecent));
  };
  fields(bring_in, settings);
  if (scale_by_screen) settings.scale = 0;
  if (!failure_of([&] { send_address(settings.send_to); }).empty()) settings.send_to = Settings().send_to;
  if (settings.samples == 3) settings.samples = 2;
}

void read(const Json& json, bool& value) {
  if (json.is_boolean()) value = json.get<bool>();
}
void read(const Json& json, std::string& value) {
  if (json.is_string()) value = json.get<std::string>();
}
void read(const Json& json, std::vector<std::string>& values) {
  if (!json.is_array()) return;
  for (const Json& one : json)
    if (one.is_string()) values.push_back(one.get<std::string>());
}
void read(const Json& json, std::map<std::string, bool>& values) {
  if (!json.is_object()) return;
  for (const auto& one : json.items())
    if (one.value().is_boolean()) values[one.key()] = one.value().get<bool>();
}
template <class Number>
void read(const Json& json, Number& value) {
  // Far outside first: what a Number cannot hold must not be converted to it.
  if (json.is_number()) value = static_cast<Number>(std::clamp(json.get<double>(), -1e9, 1e9));
}

Settings from_json(const Json& json) {
  Settings settings;
  const auto read_member = [&json](const char* name, auto& value, const auto&...) {
    if (const auto found = json.find(name); found != json.end()) read(*found, value);
  };
  fields(read_member, settings);
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
  Json json;
  const auto write_member = [&json](const char* name, const auto& value, const auto&...) {
    json[name] = value;
  };
  fields(write_member, std::as_const(kept));
  std::error_code ignored;  // writing reports what is wrong with the folder
  fs::create_directories(fs::path(path).parent_path(), ignored);
  write_file(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

std::string recent_source(const std::string& path, const std::string& motion) {
  return motion.empty() ? path : path + '\n' + motion;
}

std::vector<std::string> paths_of_recent(const std::string& entry) {
  const size_t end = entry.find('\n');
  if (end == std::string::npos) return {entry};
  return {entry.substr(0, end), entry.substr(end + 1)};
}

void remember(std::vector<std::string>& recent, std::string path) {
  if (path.empty()) return;
  recent.erase(std::remove(recent.begin(), recent.end(), path), recent.end());
  recent.insert(recent.begin(), std::move(path));
  if (recent.size() > kMostRecent) recent.resize(kMostRecent);
}

std::string taken_off(std::initializer_list<std::vector<std::string>*> lists, const std::string& entry) {
  bool any = false;
  for (std::vector<std::string>* recent : lists) {
    const auto found = std::find(recent->begin(), recent->end(), entry);
    if (found == recent->end()) continue;
    recent->erase(found);
    any = true;
  }
  return any ? "; it was taken off the recent list" : "";
}

}  // namespace understudy::app
