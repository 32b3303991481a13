#include "render/context/input_event.hpp"

#include <array>

#include "retarget/base/text.hpp"

namespace understudy::render {
namespace {

// clang-format off
constexpr std::array<std::string_view, static_cast<size_t>(Key::Count)> kNames = {
  "Unknown",
  "A", "B", "C", "D", "E", "F", "G", "H", "I", "J", "K", "L", "M", "N", "O", "P", "Q", "R", "S", "T", "U", "V", "W",
  "X", "Y", "Z",
  "0", "1", "2", "3", "4", "5", "6", "7", "8", "9",
  "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12",
  "Keypad0", "Keypad1", "Keypad2", "Keypad3", "Keypad4", "Keypad5", "Keypad6", "Keypad7", "Keypad8", "Keypad9",
  "KeypadDecimal", "KeypadDivide", "KeypadMultiply", "KeypadSubtract", "KeypadAdd", "KeypadEnter", "KeypadEqual",
  "Escape", "Enter", "Tab", "Backspace", "Insert", "Delete", "Right", "Left", "Down", "Up", "PageUp", "PageDown",
  "Home", "End",
  "Space", "Apostrophe", "Comma", "Minus", "Period", "Slash", "Semicolon", "Equal", "LeftBracket", "Backslash",
  "RightBracket", "Grave",
  "LeftShift", "LeftControl", "LeftAlt", "LeftSuper", "RightShift", "RightControl", "RightAlt", "RightSuper",
  "Menu", "CapsLock", "ScrollLock", "NumLock", "PrintScreen", "Pause",
};
// clang-format on

}  // namespace

std::string_view key_name(Key key) {
  const auto at = static_cast<size_t>(key);
  return kNames[at < kNames.size() ? at : 0];
}

std::optional<Key> key_of_name(std::string_view name) {
  for (size_t i = 1; i < kNames.size(); ++i)
    if (lower_case(kNames[i]) == lower_case(name)) return static_cast<Key>(i);
  return std::nullopt;
}

}  // namespace understudy::render
