// Help: the palette of commands, the lines of scripts, and what the mouse does.
// Marks: keys.page (.0 commands, .1 scripts, .2 mouse), keys.search, keys.K (a command), scripts.search,
// scripts.K, keys.close; help.here (the sentence), help.commands, help.close.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ui/panels/menus.hpp"

namespace understudy::ui {

/// A way to use the mouse: "Middle or Shift+left drag", "Moves the view".
struct MouseUse {
  const char *buttons, *does;
};
/// In the views, with a tool: its own uses first, then those that all tools have.
std::vector<MouseUse> mouse_uses(app::Tool tool);

/// The same as one text.
std::string views_help(app::Tool tool);

/// The same on a canvas.
std::string canvas_help(app::Tool tool);

/// What can be chosen without typing more: all that has keys, all entries of the menus, every other command
/// that needs no argument. Labels tell entries of inner menus whole: "Layout: Overlay".
std::vector<MenuItem> palette(const app::Session& session, const app::Commands& commands);

/// A dialog; call every frame while it is open. False once closed. Runs the command chosen.
bool draw_keys(const app::Session& session, PanelContext& context);

/// A dialog about what the pointer is on: empty at first, then kept in `here` until the dialog is closed.
/// False once closed.
bool draw_help_here(PanelContext& context, std::optional<Explanation>& here);

}  // namespace understudy::ui
