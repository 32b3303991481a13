// Input events as plain data, from a window, a script or a recording.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace understudy::render {

/// Keys by their labels in the user's layout, in GLFW's order where its numbers have no gaps.
enum class Key : int {
  Unknown = 0,
  // clang-format off
  A, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T, U, V, W, X, Y, Z,
  Digit0, Digit1, Digit2, Digit3, Digit4, Digit5, Digit6, Digit7, Digit8, Digit9,
  F1, F2, F3, F4, F5, F6, F7, F8, F9, F10, F11, F12,
  Keypad0, Keypad1, Keypad2, Keypad3, Keypad4, Keypad5, Keypad6, Keypad7, Keypad8, Keypad9,
  KeypadDecimal, KeypadDivide, KeypadMultiply, KeypadSubtract, KeypadAdd, KeypadEnter, KeypadEqual,
  Escape, Enter, Tab, Backspace, Insert, Delete, Right, Left, Down, Up, PageUp, PageDown, Home, End,
  Space, Apostrophe, Comma, Minus, Period, Slash, Semicolon, Equal, LeftBracket, Backslash, RightBracket, Grave,
  LeftShift, LeftControl, LeftAlt, LeftSuper, RightShift, RightControl, RightAlt, RightSuper, Menu,
  CapsLock, ScrollLock, NumLock, PrintScreen, Pause,
  // clang-format on
  Count
};

/// "A", "0", "F5", "Left", "PageUp", "Keypad1", "LeftControl", "Comma": as the enum, digits without "Digit".
std::string_view key_name(Key key);
/// The key of that name, in any case; none when there is none.
std::optional<Key> key_of_name(std::string_view name);

struct Modifiers {
  bool shift = false, control = false, alt = false, super = false;
  bool operator==(const Modifiers& o) const {
    return shift == o.shift && control == o.control && alt == o.alt && super == o.super;
  }
};

enum class MouseButton : int { Left, Right, Middle, Back, Forward, Count };

/// One thing that happened. Which fields mean something depends on the kind.
struct InputEvent {
  enum class Kind : int {
    MouseMove,    ///< x, y: to here
    MouseButton,  ///< button, pressed, modifiers, x, y
    Scroll,       ///< dx, dy: notches, dy > 0 away from the user; x, y
    Key,          ///< key, pressed, repeated, modifiers
    Char,         ///< codepoint: one Unicode character of typed text
    Drop,         ///< paths: files and folders let go over the window; x, y
    Focus,        ///< pressed: whether the window has it now
    Resize,       ///< width, height: of the framebuffer; scale: of its content
    Close         ///< the user asks the window to close
  };
  Kind kind = Kind::MouseMove;
  float x = 0, y = 0;    ///< framebuffer pixels from the top left
  float dx = 0, dy = 0;  ///< of scrolling
  render::MouseButton button = render::MouseButton::Left;
  render::Key key = render::Key::Unknown;
  bool pressed = false;   ///< false: released (Focus: lost)
  bool repeated = false;  ///< the key was held down (pressed is true too)
  Modifiers modifiers;
  char32_t codepoint = 0;
  std::vector<std::string> paths;  ///< UTF-8
  int width = 0, height = 0;       ///< pixels
  float scale = 1;                 ///< 2 on a screen of twice the usual density
};

}  // namespace understudy::render
