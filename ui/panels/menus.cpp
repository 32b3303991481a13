#include "ui/panels/menus.hpp"

#include <algorithm>

#include "ui/panels/panels.hpp"

namespace understudy::ui {
namespace {

using app::Layout;
using Items = std::vector<MenuItem>;

MenuItem line() {
  return {};
}

MenuItem group(const std::string& label, Items inside) {
  MenuItem item;
  item.label = label, item.inside = std::move(inside);
  return item;
}

MenuItem dialog(const std::string& label, const std::string& which) {
  return {label, "dialog.open", {which}, false, {}};
}

/// A switch: chosen, it becomes what it is not now.
MenuItem flag(const std::string& label, const std::string& command, bool on, app::Arguments before = {}) {
  before.push_back(on_off(!on));
  return {label, command, before, on, {}};
}

MenuItem recent(const app::Session& session) {
  Items items;
  for (const std::string& path : session.settings.recent)
    items.push_back({file_name(path), "document.open", {path}, false, {}});
  if (items.empty()) items.push_back({"Nothing yet", "", {}, false, {}});
  return group("Open recent", items);
}

Items file_menu(const app::Session& session) {
  return {{"New", "document.new", {}, false, {}},
          {"Open\u2026", "open", {}, false, {}},
          recent(session),
          line(),
          {"Open scan\u2026", "source.open", {}, false, {}},
          {"Open motion\u2026", "source.motion", {}, false, {}},
          dialog("Open target\u2026", "open_target"),
          line(),
          {session.path.empty() ? "Save\u2026" : "Save", "document.save", {}, false, {}},
          {"Save as\u2026", "document.save_as", {}, false, {}},
          line(),
          dialog("Export\u2026", "export"),
          dialog("Save picture\u2026", "picture"),
          dialog("Save video\u2026", "video"),
          line(),
          dialog("Settings\u2026", "settings"),
          {"Quit", "app.quit", {}, false, {}}};
}

Items edit_menu(const app::Session& session) {
  const std::string undo = session.history.undo_label(), redo = session.history.redo_label();
  const std::string k = std::to_string(session.selected_take);
  return {{undo.empty() ? "Undo" : "Undo " + undo, "edit.undo", {}, false, {}},
          {redo.empty() ? "Redo" : "Redo " + redo, "edit.redo", {}, false, {}},
          line(),
          {"Clear skeleton edits", "edit.skeleton_clear", {}, false, {}},
          {"Clear result edits", "edit.poses_clear", {k}, false, {}},
          {"Clear moved joints", "edit.target_joints_clear", {k}, false, {}},
          {"Clear painted weights", "edit.weights_clear", {k}, false, {}},
          line(),
          {"Pause working", "work.pause", {}, false, {}},
          {"Continue working", "work.resume", {}, false, {}},
          {"Redo all frames", "work.restart", {}, false, {}}};
}

MenuItem layouts(const app::Session& session) {
  const auto is = [&](Layout layout) { return session.view.layout == layout; };
  return group("Layout", {{"Side by side", "view.layout", {"side-by-side"}, is(Layout::SideBySide), {}},
                          {"Single", "view.layout", {"single"}, is(Layout::Single), {}},
                          {"Overlay", "view.layout", {"overlay"}, is(Layout::Overlay), {}},
                          {"Wipe", "view.layout", {"wipe"}, is(Layout::Wipe), {}}});
}

MenuItem turntable(const app::Session& session) {
  Items items;
  for (const int speed : {0, 15, 30, 60, 90})
    items.push_back({speed == 0 ? "Off" : std::to_string(speed) + "\u00b0 a second",
                     "view.turntable",
                     {std::to_string(speed)},
                     session.view.turntable_deg_s == static_cast<float>(speed),
                     {}});
  return group("Turntable", items);
}

Items view_menu(const app::Session& session) {
  const bool ortho = !session.view.cameras.empty() && session.view.cameras.front().orthographic;
  return {layouts(session),
          line(),
          {"Front", "view.preset", {"front"}, false, {}},
          {"Back", "view.preset", {"back"}, false, {}},
          {"Right", "view.preset", {"right"}, false, {}},
          {"Left", "view.preset", {"left"}, false, {}},
          {"Top", "view.preset", {"top"}, false, {}},
          {"Three-quarter", "view.preset", {"three-quarter"}, false, {}},
          {"Fit", "view.fit", {}, false, {}},
          line(),
          flag("Orthographic", "view.ortho", ortho),
          flag("Linked cameras", "view.link", session.view.linked),
          flag("Follow the person", "view.follow", session.view.follow),
          turntable(session)};
}

Items target_menu(const app::Session& session) {
  const std::string k = std::to_string(session.selected_take);
  Items items = {{"Add target\u2026", "target.add", {}, false, {}},
                 {"Replace\u2026", "target.replace", {}, false, {}},
                 {"Compare with\u2026", "compare.add", {}, false, {}},
                 {"Remove", "target.remove", {k}, false, {}}};
  if (!session.document.takes.empty()) items.push_back(line());
  for (size_t i = 0; i < session.document.takes.size(); ++i)
    items.push_back({session.document.takes[i].name,
                     "target.select",
                     {std::to_string(i)},
                     static_cast<int>(i) == session.selected_take,
                     {}});
  return items;
}

Items tools_menu(const app::Session& session) {
  Items items;
  for (const ToolChoice& tool : kTools)
    items.push_back({tool.label, "tool", {tool.argument}, session.tool == tool.tool, {}});
  return items;
}

Items window_menu(const app::Session& session) {
  Items items;
  for (const Panel& panel : panels())
    if (panel.dock == Panel::Dock::Side)
      items.push_back({panel.title, "panel.show", {panel.name, "on"}, false, {}});
  items.push_back(line());
  items.push_back(flag("Side panel", "panel.show", panel_shown(session, "side"), {"side"}));
  for (const Panel& panel : panels())
    if (panel.dock != Panel::Dock::Side)
      items.push_back(flag(panel.title, "panel.show", panel_shown(session, panel.name), {panel.name}));
  items.push_back(line());
  items.push_back({"Dark", "settings.theme", {"dark"}, session.settings.dark, {}});
  items.push_back({"Light", "settings.theme", {"light"}, !session.settings.dark, {}});
  Items scales = {{"Automatic", "settings.scale", {"auto"}, session.settings.scale == 0, {}}};
  for (const int percent : {100, 125, 150, 200, 300})
    scales.push_back({std::to_string(percent) + " %",
                      "settings.scale",
                      {argument(percent / 100.0)},
                      session.settings.scale == static_cast<float>(percent) / 100,
                      {}});
  items.push_back(group("Scale", scales));
  return items;
}

}  // namespace

std::vector<Menu> menus(const app::Session& session) {
  return {{"file", "File", file_menu(session)},
          {"edit", "Edit", edit_menu(session)},
          {"view", "View", view_menu(session)},
          {"target", "Target", target_menu(session)},
          {"tools", "Tools", tools_menu(session)},
          {"window", "Window", window_menu(session)},
          {"help",
           "Help",
           {{"All keys", "help.keys", {}, false, {}},
            dialog("About Understudy", "about"),
            {"Log", "panel.show", {"log", "on"}, false, {}}}}};
}

std::string mark_of(const MenuItem& item) {
  std::string name = "menu." + (item.command.empty() ? item.label : item.command);
  for (const std::string& argument : item.arguments) name += "." + argument;
  return name;
}

bool possible(const app::Session& session, const MenuItem& item) {
  if (item.command.empty()) return !item.inside.empty();
  if (item.command != "dialog.open") return possible(session, item.command);
  const std::string& which = item.arguments.front();
  if (which == "export" || which == "compare" || which == "replace_target")
    return selected_take(session) != nullptr;
  if (which == "save_as" || which == "picture") return has_document(session);
  return which != "video" || app::frame_count(session) > 0;
}

}  // namespace understudy::ui
