#include "ui/panels/bars.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/index.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/arrangement.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/menus.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

/// While Alt is held: a line below the letter that opens the menu with it.
void underline_letter(Ui& ui, const Menu& menu, const ImVec2& at, float height) {
  const size_t letter = menu.label.find(menu.letter);
  if (!ImGui::GetIO().KeyAlt || letter == std::string::npos) return;
  const char* const text = menu.label.c_str();
  const float from = ImGui::CalcTextSize(text, text + letter).x,
              to = ImGui::CalcTextSize(text, text + letter + 1).x;
  const float y = std::round(at.y + (height + ImGui::GetTextLineHeight()) / 2 - ui.px(1));
  ImGui::GetWindowDrawList()->AddLine({at.x + from, y}, {at.x + to, y}, color(ui.theme().text), ui.px(1));
}

/// Whether it is open.
bool draw_menu(const app::Session& session, PanelContext& context, const Menu& menu, MenuKeys& keys) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::CalcTextSize(menu.label.c_str()).x, ImGui::GetFrameHeight());
  const ImGuiWindow& window = *ImGui::GetCurrentWindow();
  const bool in_bar = window.DC.LayoutType == ImGuiLayoutType_Horizontal;
  const ImVec2 word(at.x + (in_bar ? ImGui::GetStyle().ItemSpacing.x / 2 : 0),
                    at.y + window.DC.CurrLineTextBaseOffset);
  context.ui.mark("menu." + menu.name, {word, {word.x + size.x, word.y + ImGui::GetTextLineHeight()}});
  if (keys.wanted == menu.name) {
    keys.wanted.clear();
    ImGui::OpenPopup(menu.label.c_str());
  }
  const bool open = ImGui::BeginMenu(menu.label.c_str());
  underline_letter(context.ui, menu, {at.x + ImGui::GetStyle().ItemSpacing.x / 2, at.y}, size.y);
  if (!open) return false;
  draw_menu_items(session, context, menu.items);
  ImGui::EndMenu();
  return true;
}

/// One menu that holds the others, where the bar is narrow.
void draw_one_menu(const app::Session& session, PanelContext& context, float height, MenuKeys& keys) {
  const float side = context.ui.px(28);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos({at.x, at.y + (height - side) / 2});
  const bool clicked = icon_button(context.ui, "menu", Icon::Menu, {"Menu", "", false, false, 28});
  if (clicked || !keys.wanted.empty()) ImGui::OpenPopup("menus");
  ImGui::SetNextWindowPos({at.x, at.y + height});
  if (!ImGui::BeginPopup("menus")) return;
  for (const Menu& menu : menus(session)) draw_menu(session, context, menu, keys);
  ImGui::EndPopup();
}

/// Beside each other. Left and Right lead from one that is open to the next.
void draw_menus(const app::Session& session, PanelContext& context, MenuKeys& keys) {
  const std::vector<Menu> all = menus(session);
  int open = -1;
  for (size_t i = 0; i < all.size(); ++i)
    if (draw_menu(session, context, all[i], keys)) open = static_cast<int>(i);
  if (open < 0) return;
  const int count = ssize(all);
  if (key_pressed(render::Key::Right)) keys.next = all[(open + 1) % count].name;
  if (key_pressed(render::Key::Left)) keys.next = all[(open + count - 1) % count].name;
}

/// Whether the icon was clicked; in the middle of the bar's height.
bool icon_at(Ui& ui, const ImVec2& left, const std::string& name, Icon icon, IconButtonOptions options) {
  ImGui::SetCursorScreenPos({std::round(left.x), std::round(left.y - ui.px(14))});
  options.size = 28;
  return icon_button(ui, name, icon, options);
}

void draw_tools(const app::Session& session, PanelContext& context, ImVec2 at) {
  Ui& ui = context.ui;
  for (size_t i = 0; i < kToolIcons.size(); ++i) {
    const std::string name = app::kToolNames[i];
    const IconButtonOptions options{app::kToolLabels[i], keys_of(context.commands, "tool", {name}),
                                    session.tool == static_cast<app::Tool>(i), !possible(session, "tool")};
    if (icon_at(ui, at, "tools." + name, kToolIcons[i], options)) context.ask("tool", {name});
    at.x += ui.px(31);
  }
  at.x += ui.px(10);
  const auto history = [&](const char* name, const char* command, Icon icon, const std::string& what) {
    const IconButtonOptions options{what, keys_of(context.commands, command), false,
                                    !possible(session, command)};
    if (icon_at(ui, at, name, icon, options)) context.ask(command);
    at.x += ui.px(31);
  };
  const std::string undo = app::undo_label(session), redo = app::redo_label(session);
  history("top.undo", "edit.undo", Icon::Undo, undo.empty() ? "Nothing to undo" : "Undo " + undo);
  history("top.redo", "edit.redo", Icon::Redo, redo.empty() ? "Nothing to redo" : "Redo " + redo);
}

void draw_side_switch(PanelContext& context, const Rect& area, bool shown) {
  const char* side = is_narrow(area.width(), context.ui.scale()) ? "side_over" : "side";
  const ImVec2 at(area.max.x - context.ui.px(36), area.at(0, 0.5f).y);
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

void draw_menu_bar(const app::Session& session, PanelContext& context, bool as_one, MenuKeys& keys) {
  const float height = context.ui.px(kTopBarHeight);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      {context.ui.px(8), std::floor((height - ImGui::GetFontSize()) / 2)});
  if (ImGui::BeginMenuBar()) {
    ImGui::PopStyleVar();
    if (as_one)
      draw_one_menu(session, context, height, keys);
    else
      draw_menus(session, context, keys);
    ImGui::EndMenuBar();  // closes the menu where an arrow leads out of it
    const std::string next = std::exchange(keys.next, "");
    if (!Focus::in_menu()) keys.wanted = next.empty() ? keys.wanted : next;
  } else {
    ImGui::PopStyleVar();
  }
}

}  // namespace

void draw_top_bar(const app::Session& session, PanelContext& context, const TopBar& bar, MenuKeys& keys) {
  const Rect& area = bar.area;
  if (!keys.wanted.empty() && Focus::in_menu()) {
    keys.wanted.clear();
    ImGui::ClosePopupToLevel(0, true);
  }
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
  draw_menu_bar(session, context, as_one, keys);
  const float tools = ui.px(8 * 31 + 10), layouts = ui.px(wide >= 740 ? 392 : 130);
  const float right = area.max.x - ui.px(44);
  const float left = as_one ? area.min.x + ui.px(42) : std::round(area.at(0.5f, 0).x - tools / 2);
  if (wide >= 345) draw_tools(session, context, {left, area.at(0, 0.5f).y});
  if (wide >= 500) draw_layouts(session, context, {{right - layouts, area.min.y}, {right, area.max.y}});
  if (wide >= 90) draw_side_switch(context, area, bar.side);
  ImGui::PopClipRect();
  ImGui::End();
}

}  // namespace understudy::ui
