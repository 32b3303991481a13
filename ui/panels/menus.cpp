#include "ui/panels/menus.hpp"

#include <algorithm>
#include <cctype>

#include "app/study/presets.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panels.hpp"

namespace understudy::ui {
namespace {

using Items = std::vector<MenuItem>;

const MenuItem kLine;

MenuItem group(const std::string& label, const Items& inside) {
  return {label, "", {}, false, inside};
}

/// A switch: chosen, it becomes what it is not now.
MenuItem flag(const std::string& label, const std::string& command, bool on, app::Arguments before = {}) {
  before.push_back(on_off(!on));
  return {label, command, before, on};
}

MenuItem recent(const app::Session& session) {
  Items items;
  for (const std::string& path : session.settings.recent)
    items.push_back({file_name(path), "document.open", {path}});
  if (items.empty()) items.push_back({"Nothing yet", ""});
  return group("Open recent", items);
}

Items file_menu(const app::Session& session) {
  return {{"New", "document.new"},
          {"Open\u2026", "open"},
          recent(session),
          kLine,
          {"Open source\u2026", "source.open"},
          {"Open target\u2026", "dialog.open", {"open_target"}},
          kLine,
          {session.path.empty() ? "Save\u2026" : "Save", "document.save"},
          {"Save as\u2026", "document.save_as"},
          kLine,
          {"Export\u2026", "dialog.open", {"export"}},
          {"Save picture\u2026", "dialog.open", {"picture"}},
          {"Save video\u2026", "dialog.open", {"video"}},
          {"Send to an engine\u2026", "dialog.open", {"send"}, !session.sends_to.empty()},
          kLine,
          {"Settings\u2026", "dialog.open", {"settings"}},
          {"Quit", "app.quit"}};
}

Items edit_menu(const app::Session& session) {
  const std::string undo = app::undo_label(session), redo = app::redo_label(session);
  const std::string k = std::to_string(session.selected_take);
  return {{undo.empty() ? "Undo" : "Undo " + undo, "edit.undo"},
          {redo.empty() ? "Redo" : "Redo " + redo, "edit.redo"},
          kLine,
          {"Clear skeleton edits", "edit.skeleton_clear"},
          {"Clear result edits", "edit.poses_clear", {k}},
          {"Clear moved joints", "edit.target_joints_clear", {k}},
          {"Clear painted weights", "edit.weights_clear", {k}},
          kLine,
          {"Pause processing", "work.pause"},
          {"Resume processing", "work.resume"},
          {"Recompute all frames", "work.restart"}};
}

MenuItem layouts(const app::Session& session) {
  Items items;
  for (size_t i = 0; i < kLayoutLabels.size(); ++i)
    items.push_back({kLayoutLabels[i],
                     "view.layout",
                     {app::kLayoutNames[i]},
                     static_cast<size_t>(session.view.layout) == i});
  return group("Layout", items);
}

MenuItem turntable(const app::Session& session) {
  Items items;
  for (const int speed : {0, 15, 30, 60, 90})
    items.push_back({speed == 0 ? "Off" : std::to_string(speed) + "\u00b0 a second",
                     "view.turntable",
                     {std::to_string(speed)},
                     session.view.turntable_deg_s == static_cast<float>(speed)});
  return group("Turntable", items);
}

Items view_menu(const app::Session& session) {
  const app::View& view = session.view;
  Items items = view_presets();
  items.insert(items.begin(), {layouts(session), kLine});
  for (const MenuItem& item :
       {MenuItem{"Fit", "view.fit"}, MenuItem{"Reset camera", "view.reset"}, kLine,
        flag("Orthographic", "view.ortho", app::active_camera(view).orthographic),
        flag("View cube", "view.cube", view.cube), flag("Linked cameras", "view.link", view.linked),
        flag("Follow the person", "view.follow", view.follow), turntable(session)})
    items.push_back(item);
  return items;
}

MenuItem tool_item(const app::Session& session, app::Tool tool) {
  const size_t i = static_cast<size_t>(tool);
  return {app::kToolLabels[i], std::string("tool.") + app::kToolNames[i], {}, session.tool == tool};
}

Items target_menu(const app::Session& session) {
  const app::Take* take = selected_take(session);
  const std::string k = std::to_string(session.selected_take);
  Items items = {{"Add target\u2026", "target.add"},
                 {"Replace\u2026", "target.replace"},
                 {"Compare with\u2026", "compare.add"},
                 tool_item(session, app::Tool::RestPose),
                 tool_item(session, app::Tool::Face),
                 {take == nullptr ? "Remove" : "Remove " + take->name, "target.remove", {k}}};
  if (!session.document.takes.empty()) items.push_back(kLine);
  for (size_t i = 0; i < session.document.takes.size(); ++i)
    items.push_back({session.document.takes[i].name,
                     "target.select",
                     {std::to_string(i)},
                     static_cast<int>(i) == session.selected_take});
  return items;
}

Items tools_menu(const app::Session& session) {
  Items items;
  for (size_t i = 0; i < kToolIcons.size(); ++i)
    items.push_back(tool_item(session, static_cast<app::Tool>(i)));
  return items;
}

MenuItem new_study() {
  Items items = {{"From the open takes", "study.new", {"takes"}}};
  for (const app::StudyPreset& preset : app::study_presets())
    items.push_back({preset.label, "study.new", {preset.name}});
  return group("New", items);
}

MenuItem export_trials() {
  Items items;
  for (const app::TrialFormat& format : app::trial_formats())
    items.push_back(
        {std::string(format.label) + "\u2026", "dialog.open", {std::string("study_") + format.name}});
  return group("Export trials", items);
}

Items study_menu(const app::Session& session) {
  return {new_study(),
          {"Open\u2026", "study.open"},
          kLine,
          {session.study.path.empty() ? "Save\u2026" : "Save", "study.save"},
          {"Save as\u2026", "study.save_as"},
          {"Close", "study.close"},
          kLine,
          {"Render stimuli\u2026", "dialog.open", {"study_stimuli"}},
          {"Web page\u2026", "study.web"},
          {"Run\u2026", "study.run"},
          export_trials(),
          {"Analyse answers\u2026", "dialog.open", {"study_answers"}}};
}

Items window_menu(const app::Session& session) {
  Items items;
  for (const Panel& panel : panels())
    if (panel.dock == Panel::Dock::Side)
      items.push_back({panel.title, "panel.show", {panel.name, "on"}, panel_shown(session, panel.name)});
  items.push_back(kLine);
  items.push_back(flag("Side panel", "panel.show", panel_shown(session, "side"), {"side"}));
  for (const Panel& panel : panels())
    if (panel.dock != Panel::Dock::Side)
      items.push_back(flag(panel.title, "panel.show", panel_shown(session, panel.name), {panel.name}));
  items.push_back(kLine);
  items.push_back({"Dark", "settings.theme", {"dark"}, session.settings.dark});
  items.push_back({"Light", "settings.theme", {"light"}, !session.settings.dark});
  Items scales = {{"Automatic", "settings.scale", {"auto"}, session.settings.scale == 0}};
  for (const int percent : {100, 125, 150, 200, 300})
    scales.push_back({std::to_string(percent) + " %",
                      "settings.scale",
                      {argument(percent / 100.0)},
                      session.settings.scale == static_cast<float>(percent) / 100});
  items.push_back(group("Scale", scales));
  return items;
}

Items help_menu(const app::Session&) {
  return {{"Getting started", "help.getting_started"},
          {"Commands, scripts, mouse\u2026", "help.keys"},
          {"About Understudy", "dialog.open", {"about"}},
          {"Log", "panel.show", {"log", "on"}}};
}

struct MenuRow {
  const char *name, *label;
  char letter;
  Items (*items)(const app::Session&);
};
constexpr MenuRow kMenus[] = {{"file", "File", 'F', file_menu},       {"edit", "Edit", 'E', edit_menu},
                              {"view", "View", 'V', view_menu},       {"target", "Target", 'a', target_menu},
                              {"tools", "Tools", 'o', tools_menu},    {"study", "Study", 'S', study_menu},
                              {"window", "Window", 'W', window_menu}, {"help", "Help", 'H', help_menu}};

}  // namespace

const std::vector<std::string> kLayoutLabels = {"Side by side", "Single", "Overlay", "Wipe"};

std::vector<Menu> menus(const app::Session& session) {
  std::vector<Menu> all;
  for (const MenuRow& row : kMenus) all.push_back({row.name, row.label, row.letter, row.items(session)});
  return all;
}

std::vector<Binding> menu_bindings() {
  std::vector<Binding> all;
  for (const MenuRow& row : kMenus)
    all.push_back({std::string("Alt+") + static_cast<char>(std::toupper(row.letter)),
                   "menu.open",
                   {row.name},
                   std::string("Menu: ") + row.label});
  return all;
}

Items view_presets() {
  Items items;
  for (const app::ViewPreset& preset : app::kViewPresets)
    items.push_back({preset.label, "view.preset", {preset.name}});
  return items;
}

std::string mark_of(const MenuItem& item) {
  std::string name = "menu." + (item.command.empty() ? item.label : item.command);
  for (const std::string& argument : item.arguments) name += "." + argument;
  return name;
}

void draw_menu_items(const app::Session& session, PanelContext& context, const Items& items) {
  for (const MenuItem& item : items) {
    if (item.label.empty()) {
      ImGui::Separator();
      continue;
    }
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (!item.inside.empty()) {
      const float width =
          std::max(ImGui::GetContentRegionAvail().x, ImGui::CalcTextSize(item.label.c_str()).x);
      context.ui.mark("menu." + item.label, {at, {at.x + width, at.y + ImGui::GetTextLineHeight()}});
      if (!ImGui::BeginMenu(item.label.c_str())) continue;
      draw_menu_items(session, context, item.inside);
      ImGui::EndMenu();
      continue;
    }
    const std::string keys = keys_of(context.commands, item.command, item.arguments);
    const IdScope id(mark_of(item));
    if (ImGui::MenuItem(item.label.c_str(), keys.c_str(), item.checked, possible(session, item)))
      ask_or_open(session, context, item.command, item.arguments);
    context.ui.mark(mark_of(item));
  }
}

bool possible(const app::Session& session, const MenuItem& item) {
  if (item.command.empty()) return !item.inside.empty();
  if (item.command != "dialog.open") return possible(session, item.command);
  const std::string& which = item.arguments.front();
  if (starts_with(which, "study_"))  // what a study that is not complete yet cannot do
    return session.study.study.has_value() && session.study.problem.empty();
  if (which == "export" || which == "compare" || which == "replace_target")
    return selected_take(session) != nullptr;
  if (which == "save_as" || which == "picture") return has_document(session);
  return which != "video" || app::frame_count(session) > 0;
}

}  // namespace understudy::ui
