#include "ui/panels/bars.hpp"

#include <algorithm>
#include <cmath>

#include "ui/panels/arrangement.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/menus.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

void draw_items(const app::Session& session, PanelContext& context, const std::vector<MenuItem>& items) {
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
      draw_items(session, context, item.inside);
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

void draw_menu(const app::Session& session, PanelContext& context, const Menu& menu) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::CalcTextSize(menu.label.c_str()).x, ImGui::GetFrameHeight());
  context.ui.mark("menu." + menu.name, {at, {at.x + size.x, at.y + size.y}});
  if (!ImGui::BeginMenu(menu.label.c_str())) return;
  draw_items(session, context, menu.items);
  ImGui::EndMenu();
}

/// One menu that holds the others, where the bar is narrow.
void draw_one_menu(const app::Session& session, PanelContext& context, float height) {
  const float side = context.ui.px(28);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos({at.x, at.y + (height - side) / 2});
  if (icon_button(context.ui, "menu", Icon::Menu, {"Menu", "", false, false, 28})) ImGui::OpenPopup("menus");
  ImGui::SetNextWindowPos({at.x, at.y + height});
  if (!ImGui::BeginPopup("menus")) return;
  for (const Menu& menu : menus(session)) draw_menu(session, context, menu);
  ImGui::EndPopup();
}

/// Whether the icon was clicked; in the middle of the bar's height.
bool icon_at(Ui& ui, const ImVec2& left, const std::string& name, Icon icon, IconButtonOptions options) {
  ImGui::SetCursorScreenPos({std::round(left.x), std::round(left.y - ui.px(14))});
  options.size = 28;
  return icon_button(ui, name, icon, options);
}

void draw_tools(const app::Session& session, PanelContext& context, ImVec2 at) {
  Ui& ui = context.ui;
  for (const ToolChoice& tool : kTools) {
    const IconButtonOptions options{tool.label, keys_of(context.commands, "tool", {tool.argument}),
                                    session.tool == tool.tool, !possible(session, "tool")};
    if (icon_at(ui, at, std::string("tools.") + tool.argument, tool.icon, options))
      context.ask("tool", {tool.argument});
    at.x += ui.px(31);
  }
  at.x += ui.px(10);
  const auto history = [&](const char* name, const char* command, Icon icon, const std::string& what) {
    const IconButtonOptions options{what, keys_of(context.commands, command), false,
                                    !possible(session, command)};
    if (icon_at(ui, at, name, icon, options)) context.ask(command);
    at.x += ui.px(31);
  };
  const std::string undo = session.history.undo_label(), redo = session.history.redo_label();
  history("top.undo", "edit.undo", Icon::Undo, undo.empty() ? "Nothing to undo" : "Undo " + undo);
  history("top.redo", "edit.redo", Icon::Redo, redo.empty() ? "Nothing to redo" : "Redo " + redo);
}

void draw_side_switch(const app::Session& session, PanelContext& context, const Rect& bar) {
  const char* side = is_narrow(bar.width(), context.ui.scale()) ? "side_over" : "side";
  const bool shown = panel_shown(session, side);
  const ImVec2 at(bar.max.x - context.ui.px(36), bar.at(0, 0.5f).y);
  if (icon_at(context.ui, at, "top.side", Icon::Layers,
              {shown ? "Hide the side panel" : "Show the side panel", ""}))
    context.ask("panel.show", {side, on_off(!shown)});
}

void draw_layouts(const app::Session& session, PanelContext& context, const Rect& place) {
  ImGui::SetCursorScreenPos({place.min.x, std::round(place.at(0, 0.5f).y - ImGui::GetFrameHeight() / 2)});
  const DisabledScope disabled(!possible(session, "view.layout"));
  int chosen = static_cast<int>(session.view.layout);
  ImGui::BeginChild("##layouts", {place.width(), ImGui::GetFrameHeight()});
  const bool changed = place.width() > context.ui.px(250)
                           ? segmented(context.ui, "top.layout", kLayoutLabels, chosen)
                           : dropdown(context.ui, "top.layout", kLayoutLabels, chosen);
  ImGui::EndChild();
  if (changed) context.ask("view.layout", {app::kLayoutNames[chosen]});
}

void draw_menu_bar(const app::Session& session, PanelContext& context, bool as_one) {
  const float height = context.ui.px(kTopBarHeight);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      {context.ui.px(8), std::floor((height - ImGui::GetFontSize()) / 2)});
  if (ImGui::BeginMenuBar()) {
    ImGui::PopStyleVar();
    if (as_one)
      draw_one_menu(session, context, height);
    else
      for (const Menu& menu : menus(session)) draw_menu(session, context, menu);
    ImGui::EndMenuBar();
  } else {
    ImGui::PopStyleVar();
  }
}

}  // namespace

void draw_top_bar(const app::Session& session, PanelContext& context, const Rect& area) {
  Ui& ui = context.ui;
  const float wide = area.width() / ui.scale();  // in pixels of the design
  const bool as_one = wide < 1120;
  ImGui::SetNextWindowPos(area.min);
  ImGui::SetNextWindowSize({area.width(), area.height()});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(4), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  const ColorScope background(ImGuiCol_WindowBg, ui.theme().raised);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      {ui.px(8), std::floor((area.height() - ImGui::GetFontSize()) / 2)});
  ImGui::Begin("##top", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_MenuBar |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(4);
  ImGui::PushClipRect(area.min, area.max, false);
  draw_menu_bar(session, context, as_one);
  const float tools = ui.px(8 * 31 + 10), layouts = ui.px(wide >= 740 ? 392 : 130);
  const float right = area.max.x - ui.px(44);
  const float left = as_one ? area.min.x + ui.px(42) : std::round(area.at(0.5f, 0).x - tools / 2);
  if (wide >= 345) draw_tools(session, context, {left, area.at(0, 0.5f).y});
  if (wide >= 500) draw_layouts(session, context, {{right - layouts, area.min.y}, {right, area.max.y}});
  if (wide >= 90) draw_side_switch(session, context, area);
  ImGui::PopClipRect();
  ImGui::End();
}

}  // namespace understudy::ui
