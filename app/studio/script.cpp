#include "app/studio/script.hpp"

#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>
#include <utility>

#include "app/run/interrupt.hpp"
#include "app/studio/event_text.hpp"
#include "app/studio/facts.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/key_chord.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

using render::InputEvent;
using render::MouseButton;
using Kind = InputEvent::Kind;

constexpr double kFrame = 1.0 / 60;

bool is_number(const std::string& text) {
  double value = 0;
  return parse_number(text, value);
}

InputEvent mouse_event(Kind kind, ImVec2 at, render::Modifiers modifiers = {}) {
  InputEvent event;
  event.kind = kind;
  event.x = at.x, event.y = at.y;
  event.modifiers = modifiers;
  return event;
}

InputEvent button_event(ImVec2 at, MouseButton button, bool pressed, render::Modifiers modifiers) {
  InputEvent event = mouse_event(Kind::MouseButton, at, modifiers);
  event.button = button, event.pressed = pressed;
  return event;
}

/// The characters of UTF-8 text. Throws Error where it is damaged.
std::vector<char32_t> characters_of(const std::string& text) {
  std::vector<char32_t> characters;
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int more = lead < 0x80 ? 0 : lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : -1;
    US_CHECK(more >= 0 && i + more <= text.size(), "the text is not UTF-8");
    char32_t character = more == 0 ? lead : lead & (0x3F >> more);
    for (int k = 0; k < more; ++k)
      character = (character << 6) | (static_cast<unsigned char>(text[i++]) & 0x3F);
    characters.push_back(character);
  }
  return characters;
}

/// Takes "ctrl", "shift", "alt" off the end of the words.
render::Modifiers take_modifiers(Arguments& words) {
  render::Modifiers modifiers;
  while (!words.empty() && words.back() != "super" && ui::set_modifier(modifiers, words.back()))
    words.pop_back();
  return modifiers;
}

/// The modifier keys go down and up around the events.
std::vector<InputEvent> held(const render::Modifiers& modifiers, std::vector<InputEvent> events) {
  const auto keys = ui::key_events({render::Key::Unknown, modifiers});
  const size_t half = keys.size() / 2 - 1;  // the key itself is in the middle twice
  std::vector<InputEvent> all(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(half));
  all.insert(all.end(), events.begin(), events.end());
  all.insert(all.end(), keys.end() - static_cast<std::ptrdiff_t>(half), keys.end());
  return all;
}

/// KEY [COMPARISON] VALUE.
struct Comparison {
  std::string key, sign, value;
};
Comparison comparison_of(const Arguments& words) {
  if (words.size() == 4) return {words[1], words[2], words[3]};
  return {words[1], "=", words.size() > 2 ? words[2] : ""};
}

/// What a line points at: a place, what follows it, and the keys held meanwhile.
struct Pointing {
  ImVec2 at;
  Arguments rest;
  render::Modifiers modifiers;
};

}  // namespace

/// Plays lines.
struct Script::Player {
  using Words = Arguments;
  struct Row {
    const char* name;
    size_t least, most;
    void (Player::*play)(const Words&);
  };

  Application& application;
  OffscreenSurface& surface;
  ScriptOptions options;

  static const std::vector<Row>& rows() {
    static const std::vector<Row> table = {
        {"wait", 0, 1, &Player::wait},
        {"wait_frames", 1, 1, &Player::wait_frames},
        {"wait_value", 1, 3, &Player::wait_value},
        {"frames", 1, 1, &Player::frames},
        {"screenshot", 1, 2, &Player::screenshot},
        {"resize", 2, 2, &Player::resize},
        {"log", 1, 99, &Player::log},
        {"click", 1, 5, &Player::click},
        {"double_click", 1, 5, &Player::double_click},
        {"right_click", 1, 5, &Player::right_click},
        {"hover", 1, 5, &Player::hover},
        {"drag", 3, 7, &Player::drag},
        {"drag_to", 2, 5, &Player::drag_to},
        {"scroll", 2, 6, &Player::scroll},
        {"type", 1, 1, &Player::type},
        {"key", 1, 1, &Player::key},
        {"tab_to", 1, 1, &Player::tab_to},
        {"drop", 1, 99, &Player::drop},
        {"close", 0, 0, &Player::close},
        {"expect", 1, 1, &Player::expect},
        {"expect_no", 1, 1, &Player::expect_no},
        {"expect_text", 1, 1, &Player::expect_text},
        {"expect_value", 1, 3, &Player::expect_value},
        {"expect_error", 1, 1, &Player::expect_error},
        {"event", 1, 99, &Player::event},
    };
    return table;
  }

  /// Empty lines and comments do nothing.
  void play_line(const std::string& line) {
    const Arguments words = split_line(line);
    if (words.empty()) return;
    for (const Row& row : rows())
      if (words[0] == row.name) {
        US_CHECK(words.size() > row.least && words.size() <= row.most + 1, row.name, " needs ", row.least,
                 row.least == row.most ? "" : " to " + std::to_string(row.most), " words, not ",
                 words.size() - 1);
        (this->*row.play)(words);
        return;
      }
    US_CHECK(application.studio().commands().find(words[0]), "there is no command ", words[0]);
    Arguments arguments;
    for (size_t i = 1; i < words.size(); ++i) arguments.push_back(path_of(words[i]));
    application.studio().run(words[0], arguments);
    draw(2);
  }

  // Waiting and looking.

  void draw(int count = 1) {
    for (int i = 0; i < count && !application.session().quit; ++i) {
      US_CHECK(!interrupted(), "interrupted");
      application.frame(kFrame);
    }
  }

  /// Draws until everything on the screen is made and the widgets have settled.
  void settle() {
    for (int i = 0; i < 4; ++i) {
      draw();
      application.studio().cache().wait();
    }
    until([this] { return !application.waiting(); }, "the picture", options.timeout_s);
    draw(3);
  }

  void until(const std::function<bool()>& done, const std::string& what, double timeout_s) {
    const auto began = std::chrono::steady_clock::now();
    while (!done()) {
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began;
      US_CHECK(passed.count() < timeout_s, what, " has not arrived after ", timeout_s, " s");
      US_CHECK(!application.session().quit, "the studio was closed");
      draw();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  void wait(const Words& words) {
    application.studio().wait_idle(words.size() > 1 ? static_cast<double>(number_of(words[1]))
                                                    : options.timeout_s);
    settle();
  }

  void wait_frames(const Words& words) {
    const int wanted = static_cast<int>(number_of(words[1]));
    until([&] { return frame_count(application.session()) >= wanted; }, "frame " + words[1],
          options.timeout_s);
  }

  void wait_value(const Words& words) {
    const auto [key, sign, value] = comparison_of(words);
    until([&, k = key, s = sign, v = value] { return holds(fact(application.session(), k), s, v); },
          key + " " + sign + " " + value, options.timeout_s);
  }

  void frames(const Words& words) { draw(static_cast<int>(number_of(words[1]))); }

  void screenshot(const Words& words) {
    const render::PixelSize before = surface.target().size;
    if (words.size() > 2) {
      const render::PixelSize size = size_of(words[2]);
      surface.resize(size.width, size.height);
    }
    settle();
    const fs::path path = fs::path(options.out) / path_of(words[1]);
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    render::write_png(path.string(), surface.picture());
    surface.resize(before.width, before.height);
  }

  void resize(const Words& words) {
    surface.resize(static_cast<int>(number_of(words[1])), static_cast<int>(number_of(words[2])));
    draw(2);
  }

  void log(const Words& words) {
    std::string text;
    for (size_t i = 1; i < words.size(); ++i) text += (i > 1 ? " " : "") + words[i];
    understudy::log::info(text);
  }

  // Doing.

  void send(std::vector<InputEvent> events) {
    for (InputEvent& event : events) surface.push(std::move(event));
    draw();
    while (application.gui().pending() && !application.session().quit) draw();
    draw(2);
  }

  ImVec2 place_of(const std::string& name) {
    const size_t at = name.find('@');
    const std::string mark = name.substr(0, at);
    if (!application.find(mark)) draw(3);  // windows appear after a frame
    auto found = application.find(mark);
    US_CHECK(found, "nothing on the screen is called ", mark);
    if (found->visible.empty()) {
      application.gui().ui().reveal(mark);
      draw(4);
      found = application.find(mark);
      US_CHECK(found && !found->visible.empty(), mark, " is not visible");
    }
    US_CHECK(found->enabled, mark, " is greyed out");
    if (at == std::string::npos) return found->visible.at(0.5f, 0.5f);
    const std::string shares = name.substr(at + 1);
    const size_t comma = shares.find(',');
    US_CHECK(comma != std::string::npos, name, ": needs two shares after the @");
    return found->rect.at(number_of(shares.substr(0, comma)), number_of(shares.substr(comma + 1)));
  }

  /// `places`: how many numbers follow NAME; a place is X Y when its words are numbers.
  Pointing pointing(Words words, size_t places) {
    Pointing p;
    p.modifiers = take_modifiers(words);
    words.erase(words.begin());
    const bool numbers = words.size() >= 2 && is_number(words[0]) && is_number(words[1]);
    const size_t used = numbers ? 2 : 1;
    US_CHECK(words.size() >= used, "no place is given");
    p.at = numbers ? ImVec2(number_of(words[0]), number_of(words[1])) : place_of(words[0]);
    p.rest.assign(words.begin() + static_cast<std::ptrdiff_t>(used), words.end());
    US_CHECK(p.rest.size() == places, "needs NAME or X Y", places ? ", and numbers" : "", "; there are ",
             p.rest.size(), " words more, not ", places);
    return p;
  }

  void press(const Pointing& p, MouseButton button, int times) {
    send({mouse_event(Kind::MouseMove, p.at)});
    std::vector<InputEvent> events;
    for (int i = 0; i < times; ++i) {
      events.push_back(button_event(p.at, button, true, p.modifiers));
      events.push_back(button_event(p.at, button, false, p.modifiers));
    }
    send(held(p.modifiers, std::move(events)));
  }

  void click(const Words& words) { press(pointing(words, 0), MouseButton::Left, 1); }
  void double_click(const Words& words) { press(pointing(words, 0), MouseButton::Left, 2); }
  void right_click(const Words& words) { press(pointing(words, 0), MouseButton::Right, 1); }

  void hover(const Words& words) {
    send({mouse_event(Kind::MouseMove, pointing(words, 0).at)});
    draw(60);  // until its tooltip shows
  }

  void drag_between(ImVec2 from, ImVec2 to, render::Modifiers modifiers) {
    send({mouse_event(Kind::MouseMove, from)});
    std::vector<InputEvent> events = {button_event(from, MouseButton::Left, true, modifiers)};
    constexpr int kSteps = 6;
    for (int i = 1; i <= kSteps; ++i) {
      const float t = static_cast<float>(i) / kSteps;
      events.push_back(mouse_event(Kind::MouseMove,
                                   {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}, modifiers));
    }
    send(held(modifiers, {events.front()}));
    for (size_t i = 1; i < events.size(); ++i) send({events[i]});
    send({button_event(to, MouseButton::Left, false, modifiers)});
  }

  void drag(const Words& words) {
    const Pointing p = pointing(words, 2);
    const ImVec2 by(number_of(p.rest[0]), number_of(p.rest[1]));
    const bool from_place = is_number(words[1]) && is_number(words[2]);
    drag_between(p.at, from_place ? by : ImVec2(p.at.x + by.x, p.at.y + by.y), p.modifiers);
  }

  void drag_to(const Words& words) {
    Words rest = words;
    const render::Modifiers modifiers = take_modifiers(rest);
    US_CHECK(rest.size() == 3, "drag_to needs two names");
    const ImVec2 from = place_of(rest[1]), to = place_of(rest[2]);
    drag_between(from, to, modifiers);
  }

  void scroll(const Words& words) {
    const Pointing p = pointing(words, 1);
    InputEvent event = mouse_event(Kind::Scroll, p.at, p.modifiers);
    event.dy = number_of(p.rest[0]);
    send({mouse_event(Kind::MouseMove, p.at)});
    send(held(p.modifiers, {event}));
  }

  void type(const Words& words) {
    std::vector<InputEvent> events;
    for (const char32_t character : characters_of(words[1])) {
      InputEvent event;
      event.kind = Kind::Char;
      event.codepoint = character;
      events.push_back(event);
    }
    send(std::move(events));
  }

  void key(const Words& words) {
    const auto chord = ui::chord_of(words[1]);
    US_CHECK(chord, words[1], " is not a key");
    send(key_events(*chord));
  }

  void tab_to(const Words& words) {
    constexpr int kMost = 200;  // controls in a window
    for (int i = 0; i < kMost && application.focus() != words[1]; ++i) key({"key", "Tab"});
    US_CHECK(application.focus() == words[1], "Tab does not lead to ", words[1]);
  }

  void drop(const Words& words) {
    InputEvent event;
    event.kind = Kind::Drop;
    for (size_t i = 1; i < words.size(); ++i) event.paths.push_back(path_of(words[i]));
    send({event});
  }

  void close(const Words&) {
    InputEvent event;
    event.kind = Kind::Close;
    send({event});
  }

  void event(const Words& words) {
    Words rest(words.begin() + 1, words.end());
    if (rest[0] == "drop")
      for (size_t i = 3; i < rest.size(); ++i) rest[i] = path_of(rest[i]);
    surface.push(event_of_words(rest));  // seen by the next frame that is drawn
  }

  // Looking.

  void expect(const Words& words) {
    if (!application.find(words[1])) draw(3);
    US_CHECK(application.find(words[1]), "nothing on the screen is called ", words[1]);
  }

  void expect_no(const Words& words) {
    draw(2);
    auto found = application.find(words[1]);
    US_CHECK(!found || found->visible.empty(), words[1], " is on the screen");
  }

  void expect_text(const Words& words) {
    std::string texts;
    for (const std::string& text : shown_texts(application.session())) texts += text + "\n";
    US_CHECK(texts.find(words[1]) != std::string::npos, "no dialog, notice or line of the log says \"",
             words[1], "\"");
  }

  void expect_value(const Words& words) {
    const auto [key, sign, wanted] = comparison_of(words);
    const std::string value = fact(application.session(), key);
    US_CHECK(holds(value, sign, wanted), key, " is \"", value, "\", not ", sign == "=" ? "" : sign + " ",
             "\"", wanted, "\"");
  }

  void expect_error(const Words& words) {
    draw(2);
    const Session& session = application.session();
    US_CHECK(!session.errors.empty(), "no error is shown, \"", words[1], "\" was expected");
    US_CHECK(session.errors.front().text.find(words[1]) != std::string::npos, "the error is \"",
             session.errors.front().text, "\", not \"", words[1], "\"");
    application.studio().run("error.dismiss");
  }

  std::string path_of(const std::string& argument) const {
    if (starts_with(argument, "samples/")) {
      US_CHECK(!application.studio().services().samples.empty(), "the bundled samples are missing");
      return (fs::path(application.studio().services().samples) / argument.substr(8)).string();
    }
    if (starts_with(argument, "out/")) {
      const fs::path path = fs::absolute(fs::path(options.out) / argument.substr(4));
      std::error_code failed;
      fs::create_directories(path.parent_path(), failed);
      return path.string();
    }
    return argument;
  }
};

Script::Script(Application& application, OffscreenSurface& surface, ScriptOptions options)
    : player_(std::make_unique<Player>(Player{application, surface, std::move(options)})) {}

Script::~Script() = default;

void Script::play(const std::string& text) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      player_->play_line(line);
      if (player_->application.session().quit) return;
    } catch (const Error& error) {
      throw Error(player_->options.name + ":" + std::to_string(number) + ": " + error.what());
    }
  }
}

void Script::check_no_error() const {
  const Session& session = player_->application.session();
  US_CHECK(session.errors.empty(), player_->options.name,
           ": ended with an error: ", session.errors.front().text);
}

}  // namespace understudy::app
