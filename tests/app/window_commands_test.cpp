// Commands that only the window has.
#include "app/studio/window_commands.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

TEST(WindowCommands, TogglingAPanelStartsFromWhatTheWindowShows) {
  Studio studio{StudioServices{}};
  ui::Workspace workspace;
  add_window_commands(studio.commands(), workspace);
  const auto& panels = studio.session().settings.panels;
  ASSERT_TRUE(panels.empty());  // nothing is stored: the log is hidden, the timeline shown
  for (const char* name : {"log", "timeline"}) studio.run("panel.show", {name, "toggle"});
  EXPECT_TRUE(panels.at("log"));
  EXPECT_FALSE(panels.at("timeline"));
  studio.run("panel.show", {"log", "toggle"});
  EXPECT_FALSE(panels.at("log"));
}

TEST(WindowCommands, TheFolderOfAFileIsShownByTheSystem) {
  const std::string folder = fs::temp_directory_path() / ("show in folder " + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string said = folder + "/said", opener = folder + "/xdg-open", before = std::getenv("PATH");
  std::ofstream(opener) << "#!/bin/sh\nprintf %s \"$1\" > '" << said << ".part'; mv '" << said << ".part' '"
                        << said << "'\n";
  fs::permissions(opener, fs::perms::owner_all);
  ::setenv("PATH", (folder + ":" + before).c_str(), 1);
  Studio studio{StudioServices{}};
  ui::Workspace workspace;
  add_window_commands(studio.commands(), workspace);
  studio.run("file.show", {folder + "/dance $(x).glb"});
  for (int i = 0; i < 500 && !fs::exists(said); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::string text;
  std::getline(std::ifstream(said), text);
  EXPECT_EQ(text, folder);
  ASSERT_FALSE(studio.session().notices.empty());
  EXPECT_EQ(studio.session().notices.back().text, "dance $(x).glb is in " + folder)
      << "where no program shows folders, too";
  EXPECT_THROW(studio.run("file.show", {"/no such folder/dance.glb"}), Error);
  ::setenv("PATH", before.c_str(), 1);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace understudy::app
