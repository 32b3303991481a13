// The commands of the window alone: dialogs, panels, and the jobs that draw pictures and videos off screen.
#pragma once

#include "app/session/studio.hpp"
#include "ui/panels/workspace.hpp"

namespace understudy::app {

/// The workspace must outlive the commands.
void add_window_commands(Commands& commands, ui::Workspace& workspace);

}  // namespace understudy::app
