#include "ui/panels/keys.hpp"

#include <algorithm>

#include "ui/gui/gui.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/widgets/controls.hpp"
#include "ui/widgets/dialogs.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

struct Line {
  ListItem item;
  std::string command;  ///< empty: nothing to do
  app::Arguments arguments;
};

/// What has keys first, then the mouse, then every other command.
std::vector<Line> all_lines(const app::Commands& commands) {
  std::vector<Line> lines;
  const std::vector<Binding> bound = bindings(commands);
  for (const Binding& binding : bound)
    lines.push_back({{binding.label, binding.keys}, binding.command, binding.arguments});
  constexpr const char* kMouse[][2] = {{"Orbit the view", "Left or middle drag"},
                                       {"Pan the view", "Shift+drag or right drag"},
                                       {"Zoom the view", "Wheel"},
                                       {"Zoom the timeline", "Wheel on it"},
                                       {"Pan the timeline", "Shift+wheel on it"},
                                       {"Type a number", "Double click on it"}};
  for (const auto& row : kMouse) lines.push_back({{row[0], row[1]}, "", {}});
  for (const app::Command& command : commands.all()) {
    const auto has_keys = [&](const Binding& b) { return b.command == command.name; };
    if (std::any_of(bound.begin(), bound.end(), has_keys)) continue;
    const std::string usage = command.usage.substr(0, command.usage.find(':'));
    lines.push_back({{command.label, command.name + (usage.empty() ? "" : " " + usage)},
                     usage.empty() ? command.name : "",
                     {}});
  }
  return lines;
}

}  // namespace

bool draw_keys(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "keys", "Keys and commands", 620)) return true;
  const std::vector<Line> lines = all_lines(context.commands);
  std::vector<ListItem> items;
  for (const Line& line : lines) items.push_back(line.item);
  const float room = ImGui::GetIO().DisplaySize.y - ui.px(150);
  const int chosen = searchable_list(ui, "keys", items, -1, std::max(ui.px(40), std::min(room, ui.px(460))));
  ButtonOptions close;
  close.width = -1;
  bool stays = !button(ui, "keys.close", "Close", close);
  stays &= ImGui::IsWindowAppearing() || !key_pressed(render::Key::Escape, false);
  if (chosen >= 0 && !lines[chosen].command.empty()) {
    ask_or_open(session, context, lines[chosen].command, lines[chosen].arguments);
    stays = false;
  }
  if (!stays) ImGui::CloseCurrentPopup();
  end_dialog();
  return stays;
}

}  // namespace understudy::ui
