#include "app/studio/event_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/key_chord.hpp"

namespace understudy::app {
float number_of(const std::string& text) {
  double value = 0;
  US_CHECK(parse_number(text, value) && std::isfinite(value), text, " is not a number");
  return static_cast<float>(value);
}

render::PixelSize size_of(const std::string& text) {
  const size_t x = text.find('x');
  US_CHECK(x != std::string::npos, text, " is not a size: WIDTHxHEIGHT");
  return {static_cast<int>(number_of(text.substr(0, x))), static_cast<int>(number_of(text.substr(x + 1)))};
}

namespace {

using render::InputEvent;
using Kind = InputEvent::Kind;

constexpr std::array<const char*, 5> kButtons = {"left", "right", "middle", "back", "forward"};

std::string text_of(float value) {
  return printed("%.6g", static_cast<double>(value));
}

void add_modifiers(Arguments& words, const render::Modifiers& modifiers) {
  for (const ui::Modifier& modifier : ui::kModifiers)
    if (modifiers.*modifier.held) words.push_back(modifier.name);
}

render::Modifiers modifiers_from(const Arguments& words, size_t first) {
  render::Modifiers modifiers;
  for (size_t i = first; i < words.size(); ++i)
    US_CHECK(ui::set_modifier(modifiers, words[i]) || words[i] == "repeat", words[i],
             " is not a modifier: ctrl, shift, alt, super");
  return modifiers;
}

void place_from(InputEvent& event, const Arguments& words, size_t first) {
  event.x = number_of(words[first]);
  event.y = number_of(words[first + 1]);
}

InputEvent button_of(const Arguments& words) {
  InputEvent event;
  event.kind = Kind::MouseButton;
  const auto found = std::find(kButtons.begin(), kButtons.end(), words[1]);
  US_CHECK(found != kButtons.end(), words[1], " is not a mouse button");
  event.button = static_cast<render::MouseButton>(found - kButtons.begin());
  event.pressed = words[2] == "down";
  place_from(event, words, 3);
  event.modifiers = modifiers_from(words, 5);
  return event;
}

InputEvent key_of(const Arguments& words) {
  InputEvent event;
  event.kind = Kind::Key;
  const auto key = render::key_of_name(words[1]);
  US_CHECK(key, words[1], " is not a key");
  event.key = *key;
  event.pressed = words[2] == "down";
  event.modifiers = modifiers_from(words, 3);
  event.repeated = !words.empty() && words.back() == "repeat";
  return event;
}

}  // namespace

Arguments event_words(const InputEvent& event) {
  Arguments words;
  switch (event.kind) {
    case Kind::MouseMove:
      return {"move", text_of(event.x), text_of(event.y)};
    case Kind::MouseButton:
      words = {"button", kButtons[static_cast<size_t>(event.button)], event.pressed ? "down" : "up",
               text_of(event.x), text_of(event.y)};
      add_modifiers(words, event.modifiers);
      return words;
    case Kind::Scroll:
      words = {"scroll", text_of(event.dx), text_of(event.dy), text_of(event.x), text_of(event.y)};
      add_modifiers(words, event.modifiers);
      return words;
    case Kind::Key:
      words = {"key", std::string(render::key_name(event.key)), event.pressed ? "down" : "up"};
      add_modifiers(words, event.modifiers);
      if (event.repeated) words.push_back("repeat");
      return words;
    case Kind::Char:
      return {"char", std::to_string(static_cast<uint32_t>(event.codepoint))};
    case Kind::Focus:
      return {"focus", event.pressed ? "on" : "off"};
    case Kind::Drop:
      words = {"drop", text_of(event.x), text_of(event.y)};
      words.insert(words.end(), event.paths.begin(), event.paths.end());
      return words;
    default:
      return {};
  }
}

InputEvent event_of_words(const Arguments& words) {
  static const std::map<std::string, size_t> kLeast = {{"move", 3}, {"button", 5}, {"scroll", 5}, {"key", 3},
                                                       {"char", 2}, {"focus", 2},  {"drop", 4}};
  const std::string kind = words.empty() ? "" : words[0];
  const auto least = kLeast.find(kind);
  US_CHECK(least != kLeast.end(), "there is no event ", kind);
  US_CHECK(words.size() >= least->second, "event ", kind, " needs ", least->second - 1, " words or more");
  InputEvent event;
  if (kind == "button") return button_of(words);
  if (kind == "key") return key_of(words);
  if (kind == "char") {
    event.kind = Kind::Char;
    event.codepoint = static_cast<char32_t>(number_of(words[1]));
  } else if (kind == "focus") {
    event.kind = Kind::Focus;
    event.pressed = words[1] == "on";
  } else if (kind == "scroll") {
    event.kind = Kind::Scroll;
    event.dx = number_of(words[1]), event.dy = number_of(words[2]);
    place_from(event, words, 3);
    event.modifiers = modifiers_from(words, 5);
  } else {
    event.kind = kind == "drop" ? Kind::Drop : Kind::MouseMove;
    place_from(event, words, 1);
    if (kind == "drop") event.paths.assign(words.begin() + 3, words.end());
  }
  return event;
}

}  // namespace understudy::app
