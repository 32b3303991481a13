#include "ui/panels/help.hpp"

#include <algorithm>

#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/controls.hpp"
#include "ui/widgets/dialogs.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

constexpr MouseUse kInViews[] = {
    {"Left or right drag", "Turns the view"}, {"Middle, Shift+middle or Shift+left drag", "Moves the view"},
    {"Wheel", "Zooms to the pointer"},        {"Double click", "Centres the view there"},
    {"Ctrl+right drag", "Turns the light"},   {"Right click", "Opens a menu of what can be done there"},
    {"Click a made motion", "Keeps it"}};
constexpr MouseUse kInTimeline[] = {{"Click or drag", "Goes to the frame"},
                                    {"Drag a diamond or a bar", "Moves the edit"},
                                    {"Drag an end of a bar", "Lengthens or shortens it"},
                                    {"Drag the grip of a trimmed end", "Trims more or less"},
                                    {"Escape", "Cancels a drag"},
                                    {"Wheel", "Zooms the timeline"},
                                    {"Middle drag or Shift+wheel", "Moves along the timeline"},
                                    {"Double click in the ruler", "Shows all frames"}};
constexpr MouseUse kAnywhere[] = {{"F1", "Explains what the pointer, or the ring, is on"},
                                  {"Tab, Shift+Tab", "Goes to the next control; Enter or Space uses it"},
                                  {"Alt", "Opens the menus; with a letter one of them"}};
constexpr MouseUse kInNumbers[] = {{"Drag", "Changes the number"}, {"Double click", "Lets you type it"}};

/// What a tool's own clicks do.
std::vector<MouseUse> own_uses(app::Tool tool) {
  switch (tool) {
    case app::Tool::Joints:
      return {{"Drag a joint of the source", "Moves it in this frame and those around"}};
    case app::Tool::Bones:
      return {{"Click a joint of the result", "Chooses its bone"},
              {"Click a bone found in the scan", "Chooses it"},
              {"Drag a ring", "Turns the bone"},
              {"Drag a hand or a foot", "Moves it, the limb follows"}};
    case app::Tool::TargetJoints:
      return {{"Drag a joint of the target", "Moves it in the T-pose"}};
    case app::Tool::RestPose:
      return {{"Click a joint of the target", "Chooses its bone"},
              {"Drag a ring", "Turns it in the rest pose"}};
    case app::Tool::Face:
      return {{"Drag a mark of the face", "Moves it over the head, for pose pictures"}};
    case app::Tool::Paint:
      return {{"Click a joint or a found one", "Chooses whose weights are painted"},
              {"Drag on the target or on a found surface", "Paints them"}};
    case app::Tool::Crop:
      return {{"Drag a handle of the box", "Moves that side of it"}};
    default:
      return {};
  }
}

void add_entries(const std::vector<MenuItem>& items, const std::string& before, const app::Commands& commands,
                 std::vector<MenuItem>& all) {
  for (const MenuItem& item : items) {
    add_entries(item.inside, item.label + ": ", commands, all);
    const bool has_keys = !item.command.empty() && !keys_of(commands, item.command, item.arguments).empty();
    if (item.command.empty() || has_keys) continue;
    all.push_back(item);
    all.back().label = before + item.label;
  }
}

/// Words that people look for and that no label has.
std::string other_words(const MenuItem& entry) {
  constexpr std::pair<const char*, const char*> kWords[] = {
      {"tool.joints", "fix correct wrong joint wrist elbow hand foot"},
      {"tool.bones", "fix correct wrong bone rotate wrist hand foot arm leg"},
      {"compare.add", "engine method extractor second take"},
      {"panel.show inspector",
       "engine method extractor height units scale axis fps stride style tempo performance"},
      {"panel.show layers", "colour weights difference error opacity points wireframe light"},
      {"panel.show edit", "fix clean floor crop swap smooth trim skip pin feet wrong"},
      {"panel.show metrics", "error jitter jerk skate csv latency compare"},
      {"panel.show bad_frames", "fix wrong warnings red"},
      {"dialog.open export", "save glb gltf bvh fbx animation unity unreal blender"},
      {"dialog.open video", "film movie mp4 record"},
      {"dialog.open picture", "image png screenshot"}};
  const std::string name = entry.command + (entry.arguments.empty() ? "" : " " + entry.arguments.front());
  for (const auto& [command, words] : kWords)
    if (name == command || entry.command == command) return words;
  return "";
}

struct HelpState {
  int page = 0;
};

/// The command chosen; null while none is.
const MenuItem* draw_palette(PanelContext& context, const app::Session& session,
                             const std::vector<MenuItem>& entries, float height) {
  std::vector<ListItem> items;
  items.reserve(entries.size());
  for (const MenuItem& entry : entries)
    items.push_back({entry.label, keys_of(context.commands, entry.command, entry.arguments),
                     possible(session, entry), other_words(entry)});
  const int chosen = searchable_list(context.ui, "keys", items, -1, height);
  return chosen < 0 ? nullptr : &entries[chosen];
}

void draw_scripts(PanelContext& context, float height) {
  hint(context.ui,
       "A script is a text file, a command a line; \"words in quotes\" are one argument, # begins a comment. "
       "understudy play FILE.us runs it, understudy studio --record FILE.us writes one. Choose a line to "
       "copy it.");
  std::vector<ListItem> items;
  for (const app::Command& command : context.commands.all())
    items.push_back({command.name + (command.usage.empty() ? "" : " " + command.usage), command.label});
  height -= 2 * ImGui::GetTextLineHeightWithSpacing();
  const int chosen = searchable_list(context.ui, "scripts", items, -1, height);
  if (chosen >= 0) ImGui::SetClipboardText(items[chosen].text.c_str());
}

template <class Uses>
void draw_uses(Ui& ui, const std::string& where, const Uses& uses) {
  if (std::begin(uses) == std::end(uses)) return;
  {
    const FontScope strong(ui.fonts().strong);
    ImGui::TextUnformatted(where.c_str());
  }
  for (const MouseUse& use : uses) row_text(ui, use.buttons, use.does);
  ImGui::Dummy({0, ui.px(6)});
}

void draw_mouse(Ui& ui, float height) {
  if (ImGui::BeginChild("##mouse", {0, height})) {
    draw_uses(ui, "Anywhere", kAnywhere);
    draw_uses(ui, "In the views", kInViews);
    for (size_t i = 0; i < app::kToolLabels.size(); ++i)
      draw_uses(ui, std::string("With the tool \u201c") + app::kToolLabels[i] + "\u201d",
                own_uses(static_cast<app::Tool>(i)));
    draw_uses(ui, "In the timeline", kInTimeline);
    draw_uses(ui, "On numbers", kInNumbers);
  }
  ImGui::EndChild();
}

}  // namespace

std::vector<MouseUse> mouse_uses(app::Tool tool) {
  std::vector<MouseUse> uses = own_uses(tool);
  uses.insert(uses.end(), std::begin(kInViews), std::end(kInViews));
  return uses;
}

std::string views_help(app::Tool tool) {
  std::string words;
  for (const MouseUse& use : mouse_uses(tool)) {
    std::string does = use.does;
    does[0] = static_cast<char>(does[0] - 'A' + 'a');
    words += (words.empty() ? "" : "   \u00b7   ") + std::string(use.buttons) + ": " + does;
  }
  return words;
}

std::string canvas_help(app::Tool tool) {
  const std::string own = tool == app::Tool::Joints
                              ? "Left drag on a point: moves it"
                              : "Click on somebody: they perform   \u00b7   Left drag: moves the canvas";
  return own + "   \u00b7   Wheel: zooms to the pointer   \u00b7   Double click: shows the whole canvas";
}

bool draw_help_here(PanelContext& context, std::optional<Explanation>& here) {
  Ui& ui = context.ui;
  const ImVec4* const ring = ui.focus().place();
  const ImVec2 at =
      ring != nullptr ? ImVec2((ring->x + ring->z) / 2, (ring->y + ring->w) / 2) : ImGui::GetIO().MousePos;
  if (!here) here = ui.explanation_at(at);
  if (!here) here = {{}, "", "Rest the pointer on something and press F1 to read what it is for."};
  if (!begin_dialog(ui, "help.here", here->title.empty() ? "Help" : here->title, 440)) return true;
  paragraph(here->text);
  ui.mark("help.here");
  if (!here->keys.empty()) row_text(ui, "Keys", here->keys);
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions close;
  close.look = ButtonLook::Main;
  bool stays = true;
  if (buttons.add(ui, "help.commands", "All commands", {})) context.ask("help.keys"), stays = false;
  if (buttons.add(ui, "help.close", "Close", close)) stays = false;
  const bool key = key_pressed(render::Key::F1, false) || key_pressed(render::Key::Enter, false);
  return finish_dialog(stays && !(key && !ImGui::IsWindowAppearing()));
}

std::vector<MenuItem> palette(const app::Session& session, const app::Commands& commands) {
  std::vector<MenuItem> all;
  const auto is_there = [&](const std::string& command, const app::Arguments& arguments) {
    return std::any_of(all.begin(), all.end(), [&](const MenuItem& one) {
      return one.command == command && one.arguments == arguments;
    });
  };
  for (const Binding& binding : bindings(commands))
    if (!starts_with(binding.command, "help.") && binding.command != "menu.open" &&
        !is_there(binding.command, binding.arguments))
      all.push_back({binding.label, binding.command, binding.arguments});
  for (const Menu& menu : menus(session)) add_entries(menu.items, "", commands, all);
  for (const app::Command& command : commands.all()) {
    const bool runs = command.usage.empty() && possible(session, command.name);
    if (runs && !starts_with(command.name, "help.") && command.name != "menu.open" &&
        !is_there(command.name, {}))
      all.push_back({command.label, command.name});
  }
  return all;
}

bool draw_keys(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "keys", "Help", 620)) return true;
  auto& state = panel_state<HelpState>(context);
  const bool other = segmented(ui, "keys.page", {"Commands", "Scripts", "Mouse"}, state.page);
  const float room = ImGui::GetIO().DisplaySize.y - ui.px(190);
  const float height = std::max(ui.px(40), std::min(room, ui.px(460)));
  if (state.page < 2 && (other || ImGui::IsWindowAppearing())) ImGui::SetKeyboardFocusHere();
  if (other) ui.focus().await_dialog();
  const std::vector<MenuItem> entries = palette(session, context.commands);
  const MenuItem* chosen = state.page == 0 ? draw_palette(context, session, entries, height) : nullptr;
  if (state.page == 1) draw_scripts(context, height);
  if (state.page == 2) draw_mouse(ui, height + ImGui::GetFrameHeightWithSpacing());
  ButtonOptions close;
  close.width = -1;
  bool stays = chosen == nullptr && !button(ui, "keys.close", "Close", close);
  stays &= ImGui::IsWindowAppearing() || !key_pressed(render::Key::Escape, false);
  if (chosen != nullptr) ask_or_open(session, context, chosen->command, chosen->arguments);
  if (!stays) ImGui::CloseCurrentPopup();
  end_dialog();
  return stays;
}

}  // namespace understudy::ui
