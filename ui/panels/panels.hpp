// The panels, in one table that the window, menus, keys, help and tests read. A new panel is a file
// ui/panels/NAME.cpp with its draw function, a row in panels.cpp and a test.
#pragma once

#include <typeinfo>
#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

struct Panel {
  enum class Dock {
    Side,     ///< a tab of the side panel, one at a time
    Below,    ///< in the strip below the views, beside the others that are shown there
    Timeline  ///< over the whole width of the window
  };
  const char* name;  ///< of its file and for panel.show: "bad_frames"
  const char* title;
  const char* keys;  ///< that show or hide it
  Dock dock;
  bool shown;        ///< by default
  const char* help;  ///< what it is for, a sentence or two
  /// Fills the current window. Reads the session and asks for commands.
  void (*draw)(const app::Session&, PanelContext&);
};

/// In the order of menus and tabs.
const std::vector<Panel>& panels();
/// Throws Error for a name that no panel has.
const Panel& panel_of(const std::string& name);
/// The tab of the side panel that is on: the first whose flag says so, else the first of all.
const Panel& shown_tab(const app::Session& session);

/// What a panel keeps between frames: one T a window, T() at first. Panels may share one.
template <class T>
T& panel_state(PanelContext& context) {
  return context.ui.state<T>(static_cast<ImGuiID>(typeid(T).hash_code()));
}

}  // namespace understudy::ui
