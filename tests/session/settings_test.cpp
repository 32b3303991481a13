#include "app/session/settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "app/session/series.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

class SettingsTest : public testing::Test {
 protected:
  SettingsTest() {
    sink_ = log::set_sink([this](log::Level, const std::string& message) { told_.push_back(message); });
  }
  ~SettingsTest() override { log::set_sink(sink_); }
  Settings read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_settings(path_);
  }
  tests::ScratchFolder scratch_;
  std::string path_ = scratch_.path("settings.json");
  std::vector<std::string> told_;
  log::Sink sink_;
};

TEST_F(SettingsTest, AreRemembered) {
  Settings settings;
  settings.dark = false;
  settings.scale = 1.3f;
  settings.samples = 2;
  settings.mouse_sensitivity = 0.7f;
  settings.autosave_s = 33.5;
  settings.cache_mb = 100;
  settings.undo_depth = 20;
  settings.recent = {"/a b/ü.understudy", "/c.understudy"};
  settings.recent_sources = {"/scans"};
  settings.recent_targets = {"/t.obj"};
  settings.panels = {{"Metrics", false}, {"Log", true}};
  settings.last_folder = "/last";
  settings.export_format = "bvh";
  settings.send_to = "osc://10.0.0.5:9001";
  settings.getting_started = 3;
  settings.window_width = 1920;
  settings.window_height = 1000;
  const std::string path = scratch_.path("not/there yet/settings.json");
  write_settings(path, settings);
  const Settings again = read_settings(path);
  EXPECT_EQ(again.dark, settings.dark);
  EXPECT_EQ(again.scale, settings.scale);
  EXPECT_EQ(again.samples, settings.samples);
  EXPECT_EQ(again.mouse_sensitivity, settings.mouse_sensitivity);
  EXPECT_EQ(again.autosave_s, settings.autosave_s);
  EXPECT_EQ(again.cache_mb, settings.cache_mb);
  EXPECT_EQ(again.undo_depth, settings.undo_depth);
  EXPECT_EQ(again.recent, settings.recent);
  EXPECT_EQ(again.recent_sources, settings.recent_sources);
  EXPECT_EQ(again.recent_targets, settings.recent_targets);
  EXPECT_EQ(again.panels, settings.panels);
  EXPECT_EQ(again.last_folder, settings.last_folder);
  EXPECT_EQ(again.export_format, settings.export_format);
  EXPECT_EQ(again.send_to, settings.send_to);
  EXPECT_EQ(again.getting_started, settings.getting_started);
  EXPECT_EQ(again.window_width, settings.window_width);
  EXPECT_EQ(again.window_height, settings.window_height);
}

TEST_F(SettingsTest, AreTheFirstOnesWithoutAFile) {
  EXPECT_EQ(read_settings(path_).cache_mb, Settings().cache_mb);
  EXPECT_TRUE(told_.empty());  // the first run is no problem
}

TEST_F(SettingsTest, AreBroughtIntoTheirRange) {
  const Settings low = read(R"({"scale": 0.1, "mouse_sensitivity": 0, "autosave_s": -5, "cache_mb": -1e300,
                                "undo_depth": 0, "samples": 0, "window_width": 1, "window_height": 1})");
  EXPECT_EQ(low.scale, 0.75f);
  EXPECT_EQ(low.mouse_sensitivity, 0.2f);
  EXPECT_EQ(low.autosave_s, 5);
  EXPECT_EQ(low.cache_mb, 64);
  EXPECT_EQ(low.undo_depth, 10);
  EXPECT_EQ(low.samples, 1);
  EXPECT_EQ(low.window_width, 400);
  const Settings high = read(R"({"scale": 99, "cache_mb": 1e300, "undo_depth": 4294967296, "samples": 3})");
  EXPECT_EQ(high.scale, 3);
  EXPECT_EQ(high.cache_mb, 8192);
  EXPECT_EQ(high.undo_depth, 1000);
  EXPECT_EQ(high.samples, 2);                   // there is no 3
  EXPECT_EQ(read(R"({"scale": 0})").scale, 0);  // as the screen says
  EXPECT_TRUE(told_.empty());
}

TEST_F(SettingsTest, OfAnotherTypeStayTheFirstOnes) {
  const Settings settings = read(R"({"dark": 0, "scale": "big", "cache_mb": [1], "recent": "a", "panels": [],
                                     "recent_sources": ["a", 3, "b"], "last_folder": null, "unknown": {}})");
  EXPECT_TRUE(settings.dark);
  EXPECT_EQ(settings.scale, 0);
  EXPECT_EQ(settings.cache_mb, 512);
  EXPECT_TRUE(settings.recent.empty());
  EXPECT_EQ(settings.recent_sources, (std::vector<std::string>{"a", "b"}));
}

TEST_F(SettingsTest, ThatAreNoJsonAreToldOf) {
  for (const char* text : {"", "{", "[1]", "\xff\xfe", "{\"scale\": 1e999}"}) {
    told_.clear();
    EXPECT_EQ(read(text).cache_mb, 512) << text;
    ASSERT_EQ(told_.size(), 1u) << text;
    EXPECT_NE(told_[0].find(path_), std::string::npos);
  }
  told_.clear();
  read_settings(scratch_.path(""));  // a folder
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(SettingsTest, WhatIsNotANumberIsNotWritten) {
  Settings settings;
  settings.mouse_sensitivity = std::nanf("");
  settings.autosave_s = std::numeric_limits<double>::infinity();
  settings.last_folder = "/caf\xe9";
  write_settings(path_, settings);
  const Settings again = read_settings(path_);
  EXPECT_EQ(again.mouse_sensitivity, 1);
  EXPECT_EQ(again.autosave_s, 600);
  EXPECT_TRUE(told_.empty());
  EXPECT_THROW(write_settings("/proc/nowhere/settings.json", settings), Error);
}

TEST_F(SettingsTest, RecentOnesAreFewAndTheNewestFirst) {
  std::vector<std::string> recent;
  for (int i = 0; i < 20; ++i) remember(recent, "/" + std::to_string(i));
  ASSERT_EQ(recent.size(), 12u);
  EXPECT_EQ(recent[0], "/19");
  remember(recent, recent[5]);
  EXPECT_EQ(recent[0], "/14");
  EXPECT_EQ(recent.size(), 12u);
  remember(recent, "");
  EXPECT_EQ(recent[0], "/14");
}

/// The environment as it was, afterwards.
class FolderTest : public testing::Test {
 protected:
  void set(const char* name, const char* value) {
    const char* old = std::getenv(name);
    if (old_.count(name) == 0) old_[name] = old ? std::optional<std::string>(old) : std::nullopt;
    value ? setenv(name, value, 1) : unsetenv(name);
  }
  ~FolderTest() override {
    for (const auto& [name, value] : old_)
      value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
  }
  std::map<std::string, std::optional<std::string>> old_;
};

TEST_F(FolderTest, FollowTheEnvironment) {
  set("HOME", "/home/me");
  for (const char* name : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "UNDERSTUDY_CONFIG", "UNDERSTUDY_STATE"})
    set(name, nullptr);
  EXPECT_EQ(config_folder(), "/home/me/.config/understudy");
  EXPECT_EQ(state_folder(), "/home/me/.local/state/understudy");
  set("XDG_CONFIG_HOME", "relative");  // does not count
  EXPECT_EQ(config_folder(), "/home/me/.config/understudy");
  set("XDG_CONFIG_HOME", "/conf");
  set("XDG_STATE_HOME", "/state");
  EXPECT_EQ(config_folder(), "/conf/understudy");
  EXPECT_EQ(state_folder(), "/state/understudy");
  set("UNDERSTUDY_CONFIG", "/mine");
  set("UNDERSTUDY_STATE", "/mine too");
  EXPECT_EQ(config_folder(), "/mine");
  EXPECT_EQ(state_folder(), "/mine too");
  set("UNDERSTUDY_STATE", nullptr);
  set("XDG_STATE_HOME", nullptr);
  set("HOME", nullptr);
  EXPECT_TRUE(fs::path(state_folder()).is_absolute());
}

TEST(SeriesTest, AreFoundByKey) {
  const std::vector<Series> series{{"a", "A", "m", {1}}, {"b", "B", "", {2}}};
  EXPECT_EQ(find(series, "b")->values[0], 2);
  EXPECT_EQ(find(series, "c"), nullptr);
}

TEST(SeriesTest, AreWrittenAFrameARow) {
  tests::ScratchFolder scratch;
  const std::string path = scratch.path("a b.csv");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_csv(path, {{"jerk", "Jerk", "m/s3", {0.1f, nan, 1e-8f}}, {"odd, \"one\"", "", "", {2}}}, 30);
  EXPECT_EQ(tests::read_bytes(path),
            "frame,seconds,jerk,\"odd, \"\"one\"\"\"\n"
            "0,0,0.1,2\n"
            "1,0.033333,,\n"
            "2,0.066667,1e-08,\n");
  write_csv(path, {{"jerk", "Jerk", "m/s3", {1, 2}}}, 30, {0, 0.5});
  EXPECT_EQ(tests::read_bytes(path),
            "frame,seconds,take_seconds,jerk\n"
            "0,0,0,1\n"
            "1,0.033333,0.5,2\n");
  write_csv(path, {}, 30);
  EXPECT_EQ(tests::read_bytes(path), "frame,seconds\n");
  EXPECT_THROW(write_csv(path, {}, 0), Error);
  EXPECT_THROW(write_csv(scratch.path("no/a.csv"), {}, 30), Error);
}

}  // namespace
}  // namespace understudy::app
