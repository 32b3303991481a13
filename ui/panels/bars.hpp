// The bars at the top (menus, tools, layout) and at the bottom (jobs and their progress, the last message,
// frames per second).
// Marks: menu.NAME (file, edit, view, target, tools, study, window, help; "menu" where they are one), entries
// as mark_of(MenuItem); tools.look ... tools.crop; top.undo, top.redo, top.layout(.0 to .3), top.side;
// status.job (with status.job.cancel), status.more_jobs, status.message (opens the log), status.mouse,
// status.sending, status.document, status.rate.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

constexpr float kTopBarHeight = 42, kStatusHeight = 36;  ///< at scale 1

/// Which menu keys open.
struct MenuKeys {
  std::string wanted;  ///< by its name; empty: none
  std::string next;    ///< the one that Left or Right leads to
};

struct TopBar {
  Rect area;
  bool side = false;  ///< whether the side panel is on
};

/// In the area given, as one window. Where the keys' menu, or any other, is open already, it closes.
void draw_top_bar(const app::Session& session, PanelContext& context, const TopBar& bar, MenuKeys& keys);

/// Fills the current window. `frame_rate`: of the window, frames per second; 0: not known.
void draw_status(const app::Session& session, PanelContext& context, float frame_rate);

}  // namespace understudy::ui
