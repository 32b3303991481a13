// Commands that only the window has.
#include "app/studio/window_commands.hpp"

#include <gtest/gtest.h>

namespace understudy::app {
namespace {

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

}  // namespace
}  // namespace understudy::app
