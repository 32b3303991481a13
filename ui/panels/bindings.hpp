// Which key does what: the registry's shortcuts, and keys for commands with arguments.
#pragma once

#include <string>
#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

struct Binding {
  std::string keys;  ///< "Ctrl+Shift+S", "Space"
  std::string command;
  app::Arguments arguments;
  std::string label;  ///< "Save as"
};

/// All bindings; the registry's win over those built in here.
std::vector<Binding> bindings(const app::Commands& commands);

/// The keys of a command with exactly these arguments; "" where there are none. Commands that ask for a file
/// first are found by what they do in the end: "document.save_as".
std::string keys_of(const app::Commands& commands, const std::string& command,
                    const app::Arguments& arguments = {});

/// Whether "Ctrl+S" was pressed in this frame, with exactly these modifiers. False for unknown keys.
bool pressed(const std::string& keys);

/// Pushes the commands of the keys pressed in this frame, unless the user is typing or a dialog is open.
/// Escape goes back to looking around.
void ask_for_keys(const app::Session& session, PanelContext& context);

/// Pushes a command, or opens the dialog that asks for its missing path.
void ask_or_open(const app::Session& session, PanelContext& context, const std::string& command,
                 const app::Arguments& arguments = {});

}  // namespace understudy::ui
