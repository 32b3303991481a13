// The menus as plain data, so that tests can read every entry without opening it.
#pragma once

#include <string>
#include <vector>

#include "ui/panels/bindings.hpp"

namespace understudy::ui {

struct MenuItem {
  std::string label = {};    ///< empty: a line between groups
  std::string command = {};  ///< one that needs a path and has none opens the dialog that asks for it
  app::Arguments arguments = {};
  bool checked = false;               ///< on, or chosen
  std::vector<MenuItem> inside = {};  ///< a menu of its own
};

struct Menu {
  std::string name;  ///< "file"; marked menu.file
  std::string label;
  char letter;  ///< of the label: with Alt it opens the menu
  std::vector<MenuItem> items;
};

extern const std::vector<std::string> kLayoutLabels;  ///< in the order of app::Layout

/// File, Edit, View, Target, Tools, Study, Window, Help.
std::vector<Menu> menus(const app::Session& session);

/// The keys that open each of them.
std::vector<Binding> menu_bindings();
/// Entries that look from each app::kViewPresets.
std::vector<MenuItem> view_presets();

/// The mark of an entry: "menu.view.layout.single".
std::string mark_of(const MenuItem& item);
/// Draws entries into the current menu or popup; what is chosen is asked for.
void draw_menu_items(const app::Session& session, PanelContext& context, const std::vector<MenuItem>& items);
/// Whether the entry can be chosen now.
bool possible(const app::Session& session, const MenuItem& item);

}  // namespace understudy::ui
