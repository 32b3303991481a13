// The bar at the top: menus, tools, layout.
// Marks: menu.NAME (file, edit, view, target, tools, window, help; "menu" where they are one), entries as
// mark_of(MenuItem); tools.look ... tools.crop; top.undo, top.redo, top.layout(.0 to .3), top.side.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Height of the bar at scale 1.
constexpr float kTopBarHeight = 42;

/// In the area given, as one window.
void draw_top_bar(const app::Session& session, PanelContext& context, const Rect& area);

}  // namespace understudy::ui
