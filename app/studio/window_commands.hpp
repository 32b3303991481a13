// The commands of the window alone: dialogs.
#pragma once

#include "app/session/studio.hpp"
#include "ui/panels/workspace.hpp"

namespace understudy::app {

/// Adds help.keys and dialog.open. The workspace must outlive the commands.
void add_window_commands(Commands& commands, ui::Workspace& workspace);

}  // namespace understudy::app
