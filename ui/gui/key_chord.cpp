#include "ui/gui/key_chord.hpp"

#include <utility>

#include "retarget/base/text.hpp"

namespace understudy::ui {
namespace {

using render::InputEvent;
using render::Key;

/// Names of keys as people write them.
std::optional<Key> key_of(const std::string& name) {
  static const std::pair<const char*, Key> kOthers[] = {
      {"[", Key::LeftBracket}, {"]", Key::RightBracket}, {",", Key::Comma},      {".", Key::Period},
      {"/", Key::Slash},       {"?", Key::Slash},        {";", Key::Semicolon},  {"'", Key::Apostrophe},
      {"-", Key::Minus},       {"=", Key::Equal},        {"\\", Key::Backslash}, {"`", Key::Grave},
      {"del", Key::Delete},    {"esc", Key::Escape},     {"return", Key::Enter}, {"pgup", Key::PageUp},
      {"pgdn", Key::PageDown}, {"page up", Key::PageUp}, {"ins", Key::Insert},   {"page down", Key::PageDown},
  };
  for (const auto& [text, key] : kOthers)
    if (lower_case(name) == text) return key;
  return render::key_of_name(name);
}

InputEvent key_event(Key key, bool pressed, render::Modifiers modifiers) {
  InputEvent event;
  event.kind = InputEvent::Kind::Key;
  event.key = key, event.pressed = pressed, event.modifiers = modifiers;
  return event;
}

}  // namespace

bool set_modifier(render::Modifiers& modifiers, const std::string& name) {
  for (const Modifier& modifier : kModifiers)
    if (name == modifier.name) return modifiers.*modifier.held = true;
  return false;
}

std::optional<KeyChord> chord_of(const std::string& text) {
  KeyChord chord;
  size_t begin = 0;
  while (true) {
    const size_t plus = text.find('+', begin);
    if (plus == std::string::npos || plus + 1 >= text.size()) break;
    const std::string modifier = lower_case(text.substr(begin, plus - begin));
    if (!set_modifier(chord.modifiers, modifier == "control" ? "ctrl" : modifier)) return std::nullopt;
    begin = plus + 1;
  }
  const std::string name = text.substr(begin);
  if (name.empty()) return std::nullopt;
  if (name == "+") {
    chord.key = Key::Equal, chord.modifiers.shift = true;
    return chord;
  }
  const auto key = key_of(name);
  if (!key) return std::nullopt;
  chord.key = *key;
  if (name == "?") chord.modifiers.shift = true;
  return chord;
}

std::vector<InputEvent> key_events(const KeyChord& chord) {
  std::vector<InputEvent> events;
  for (const Modifier& modifier : kModifiers)
    if (chord.modifiers.*modifier.held) events.push_back(key_event(modifier.key, true, chord.modifiers));
  events.push_back(key_event(chord.key, true, chord.modifiers));
  events.push_back(key_event(chord.key, false, chord.modifiers));
  for (const Modifier& modifier : kModifiers)
    if (chord.modifiers.*modifier.held) events.push_back(key_event(modifier.key, false, {}));
  return events;
}

}  // namespace understudy::ui
