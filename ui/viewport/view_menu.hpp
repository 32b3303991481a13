// What a right click in a view offers.
#pragma once

#include <optional>

#include "ui/panels/menus.hpp"
#include "ui/viewport/panes.hpp"

namespace understudy::ui {

/// Where it was clicked.
struct ViewMenuPlace {
  PaneContent pane;
  int joint = -1;  ///< under the pointer, -1 for none
  app::Arguments centred =
      {};  ///< of view.camera_state with the surface there in the middle; empty: there is none
};

/// Entries about that view alone: its camera, what it shows, the joint. Commands act on the active view: make
/// it that one.
std::vector<MenuItem> view_menu_items(const app::Session& session, const ViewMenuPlace& place);

}  // namespace understudy::ui
