// The commands that are about the window alone: dialogs.
#pragma once

#include "app/session/studio.hpp"
#include "ui/panels/workspace.hpp"

namespace understudy::app {

/// help.keys, dialog.open. The workspace outlives the commands' use.
void add_window_commands(Commands& commands, ui::Workspace& workspace);

}  // namespace understudy::app
