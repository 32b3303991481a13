#include "ui/panels/bindings.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "ui/gui/gui.hpp"
#include "ui/gui/key_chord.hpp"
#include "ui/panels/files.hpp"
#include "ui/panels/menus.hpp"
#include "ui/panels/panels.hpp"

namespace understudy::ui {
namespace {

// Keys of commands that ask for a file first, of dialogs, and second keys.
const std::vector<Binding> kBuiltIn = {{"Ctrl+O", "open", {}, "Open"},
                                       {"Ctrl+S", "document.save", {}, "Save"},
                                       {"Ctrl+Shift+S", "document.save_as", {}, "Save as"},
                                       {"Ctrl+E", "dialog.open", {"export"}, "Export"},
                                       {"Ctrl+,", "dialog.open", {"settings"}, "Settings"},
                                       {"Ctrl+Y", "edit.redo", {}, "Redo"},
                                       {"Shift+Left", "playback.step", {"-10"}, "Ten frames back"},
                                       {"Shift+Right", "playback.step", {"10"}, "Ten frames forward"},
                                       {"H", "help.keys", {}, "Help"},
                                       {"?", "help.keys", {}, "Help"},
                                       {"F3", "help.keys", {}, "Help"},
                                       {"F1", "help.here", {}, "What is this?"},
                                       {"F10", "menu.open", {}, "Menus"}};

/// Whether keys with these arguments do, or undo, what `asked` does.
bool same_or_toggles(const app::Arguments& keys, const app::Arguments& asked) {
  return keys == asked ||
         (keys.size() == 2 && asked.size() == 2 && keys[0] == asked[0] && keys[1] == "toggle");
}

/// The dialog that asks for what a command without arguments misses; null where nothing is missing.
const char* dialog_for(const app::Session& session, const std::string& command) {
  if (command == "document.save") return session.path.empty() ? "save_as" : nullptr;
  if (command == "study.save") return session.study.path.empty() ? "save_study" : nullptr;
  if (command == "study.save_as") return "save_study";
  if (command == "study.web") return "study_web";
  if (command == "study.run") return "study_run";
  if (command == "export.run") return "export";
  if (command == "picture.save") return "picture";
  if (command == "video.save") return "video";
  return command == "compare.add" ? "compare" : file_dialog_for(command);
}

}  // namespace

std::vector<Binding> bindings(const app::Commands& commands) {
  std::vector<Binding> all;
  for (const app::Command& command : commands.all())
    if (!command.shortcut.empty()) all.push_back({command.shortcut, command.name, {}, command.label});
  for (const Binding& binding : kBuiltIn) {
    const auto taken = [&](const Binding& other) { return other.keys == binding.keys; };
    if (std::none_of(all.begin(), all.end(), taken)) all.push_back(binding);
  }
  for (Binding& binding : menu_bindings()) all.push_back(std::move(binding));
  for (const Panel& panel : panels())
    all.push_back({panel.keys, "panel.show", {panel.name, "toggle"}, std::string("Panel: ") + panel.title});
  return all;
}

std::string keys_of(const app::Commands& commands, const std::string& command,
                    const app::Arguments& arguments) {
  std::vector<std::string> names;
  if (!arguments.empty())  // "view.preset front" is "view.preset_front", too
    names = {command + "_" + arguments.front(), command + "." + arguments.front()};
  if (arguments.empty() || arguments == app::Arguments{"on"} || arguments == app::Arguments{"off"})
    names.push_back(command);  // a key without arguments turns a switch over
  for (const std::string& name : names) {
    const app::Command* found = commands.find(name);
    if (found != nullptr && !found->shortcut.empty()) return found->shortcut;
  }
  for (const Binding& binding : bindings(commands))
    if (binding.command == command && same_or_toggles(binding.arguments, arguments)) return binding.keys;
  return "";
}

bool pressed(const std::string& keys) {
  const auto chord = chord_of(keys);
  const ImGuiIO& io = ImGui::GetIO();
  return chord && render::Modifiers{io.KeyShift, io.KeyCtrl, io.KeyAlt, false} == chord->modifiers &&
         key_pressed(chord->key);
}

void ask_or_open(const app::Session& session, PanelContext& context, const std::string& command,
                 const app::Arguments& arguments) {
  if (!possible(session, command)) return;
  if (command == "panel.show" && arguments.size() == 2 && arguments[1] == "toggle") {
    const bool tab = panel_of(arguments[0]).dock == Panel::Dock::Side;  // tabs are only ever turned on
    return context.ask(command, {arguments[0], on_off(tab || !panel_shown(session, arguments[0]))});
  }
  const char* dialog = arguments.empty() ? dialog_for(session, command) : nullptr;
  if (dialog != nullptr)
    context.ask("dialog.open", {dialog});
  else
    context.ask(command, arguments);
}

void ask_for_keys(const app::Session& session, PanelContext& context) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool any = std::find(std::begin(io.KeysDown), std::end(io.KeysDown), true) != std::end(io.KeysDown);
  if (!any || io.WantTextInput || !ImGui::GetCurrentContext()->OpenPopupStack.empty()) return;
  for (const Binding& binding : bindings(context.commands))
    if (pressed(binding.keys)) return ask_or_open(session, context, binding.command, binding.arguments);
  const bool drags = ImGui::IsMouseDown(ImGuiMouseButton_Left);  // Escape ends the drag
  if (session.tool != app::Tool::Look && !drags && pressed("Escape")) context.ask("tool", {"look"});
}

}  // namespace understudy::ui
