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

/// All that are in force; the registry's win over those built in here.
std::vector<Binding> bindings(const app::Commands& commands);

/// The keys of a command with exactly these arguments; "" where there are none. Commands that ask for a file
/// first are found by what they do in the end: "document.save_as".
std::string keys_of(const app::Commands& commands, const std::string& command,
                    const app::Arguments& arguments = {});

/// Whether "Ctrl+S" was pressed in this frame, with these modifiers and no others. False for keys that there
/// are not.
bool pressed(const std::string& keys);

/// Asks for what the keys pressed in this frame stand for, unless something is being typed or a dialog waits.
void ask_for_keys(const app::Session& session, PanelContext& context);

/// A command as a user means it: one that wants a path and has none opens the dialog that asks for it.
void ask_or_open(const app::Session& session, PanelContext& context, const std::string& command,
                 const app::Arguments& arguments = {});

}  // namespace understudy::ui
