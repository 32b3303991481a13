// A session full of everything, and an interface that shows panels of it and collects what they ask for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/session/studio.hpp"
#include "tests/ui/support/ui_test.hpp"
#include "ui/panels/panel.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/workspace.hpp"

namespace understudy::ui {

/// A source of 60 frames of which 48 are made, two takes with figures, jobs, a log: nothing is read from
/// disk.
app::Session loaded_session();

class PanelsTest : public UiTest {
 protected:
  PanelsTest() { input.size = {360, 2600}; }

  app::Studio studio{app::StudioServices{}};  ///< for its registry
  app::Session session = loaded_session();
  app::CommandQueue queue;
  PanelContext context{gui.ui(), queue, studio.commands()};

  /// Flags a frame of the source.
  void flag_frame(int frame, const std::string& reason);
  /// Shows one panel in a window that covers the display.
  void panel(std::function<void()> draw);
  /// The panel of this name in the table.
  void panel(const std::string& name);
  /// A failure unless there is such a command.
  void expect_known(const std::string& command) const;
  /// What was asked for since the last call, as lines of a script.
  std::vector<std::string> asked();
  /// Clicks, and expects exactly these lines.
  void expect_click(const std::string& mark, const std::vector<std::string>& lines);
  /// Opens a list and chooses one of its lines.
  void expect_choice(const std::string& mark, int choice, const std::vector<std::string>& lines);
  /// Writes into a field in place of what is there, Enter.
  void expect_typed(const std::string& mark, const std::string& text, const std::vector<std::string>& lines);
  /// Drags a number; expects commands of that beginning, at least one.
  void expect_drag(const std::string& mark, const std::string& beginning);
  void write_into(const std::string& mark, const std::string& text);
};

/// The whole window; what only the window can do is done as the application does it.
class WorkspaceTest : public PanelsTest {
 protected:
  WorkspaceTest();
  Workspace workspace;
  int views_drawn = 0;
  std::vector<std::string> log;  ///< all that was asked for, in order

  /// Panels, dialogs, the selection and answers: what the commands of the application do.
  void obey();
  /// Takes what was logged.
  std::vector<std::string> take_log();
};

}  // namespace understudy::ui
