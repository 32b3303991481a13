// Keys with their modifiers, as menus and scripts write them: "Ctrl+Shift+S", "Space", "?".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/context/input_event.hpp"

namespace understudy::ui {

struct KeyChord {
  render::Key key = render::Key::Unknown;
  render::Modifiers modifiers;
};

/// "Ctrl+Shift+S", "F1", "Space", "Left", "[", "?"; none when it names no key.
std::optional<KeyChord> chord_of(const std::string& text);

/// The modifiers as scripts write them, and their keys.
struct Modifier {
  const char* name;
  bool render::Modifiers::*held;
  render::Key key;
};
constexpr Modifier kModifiers[] = {{"ctrl", &render::Modifiers::control, render::Key::LeftControl},
                                   {"shift", &render::Modifiers::shift, render::Key::LeftShift},
                                   {"alt", &render::Modifiers::alt, render::Key::LeftAlt},
                                   {"super", &render::Modifiers::super, render::Key::LeftSuper}};
/// False where it is the name of none.
bool set_modifier(render::Modifiers& modifiers, const std::string& name);

/// Presses and releases, modifier keys around them.
std::vector<render::InputEvent> key_events(const KeyChord& chord);

}  // namespace understudy::ui
