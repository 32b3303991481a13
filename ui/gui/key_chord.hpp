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

/// Presses and releases, modifier keys around them.
std::vector<render::InputEvent> key_events(const KeyChord& chord);

}  // namespace understudy::ui
