// Events and facts as text.
#include <gtest/gtest.h>

#include "app/studio/event_text.hpp"
#include "app/studio/facts.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

using render::InputEvent;
using render::Key;
using Kind = InputEvent::Kind;

std::vector<InputEvent> one_of_each() {
  std::vector<InputEvent> events(7);
  events[0].kind = Kind::MouseMove, events[0].x = 12.5f, events[0].y = 301;
  events[1].kind = Kind::MouseButton, events[1].button = render::MouseButton::Middle;
  events[1].pressed = true, events[1].x = 3, events[1].modifiers.shift = events[1].modifiers.alt = true;
  events[2].kind = Kind::Scroll, events[2].dy = -0.25f, events[2].y = 9;
  events[3].kind = Kind::Key, events[3].key = Key::PageDown, events[3].pressed = true;
  events[3].repeated = true, events[3].modifiers.control = true;
  events[4].kind = Kind::Char, events[4].codepoint = U'ä';
  events[5].kind = Kind::Focus, events[5].pressed = false;
  events[6].kind = Kind::Drop, events[6].paths = {"/a scan", "/b\"c"};
  return events;
}

TEST(EventText, ComesBackAsItWas) {
  for (const InputEvent& event : one_of_each()) {
    const std::string line = join_line("event", event_words(event));
    Arguments words = split_line(line);
    words.erase(words.begin());
    const InputEvent back = event_of_words(words);
    EXPECT_EQ(back.kind, event.kind) << line;
    EXPECT_EQ(back.x, event.x) << line;
    EXPECT_EQ(back.y, event.y) << line;
    EXPECT_EQ(back.dy, event.dy) << line;
    EXPECT_EQ(back.button, event.button) << line;
    EXPECT_EQ(back.key, event.key) << line;
    EXPECT_EQ(back.pressed, event.pressed) << line;
    EXPECT_EQ(back.repeated, event.repeated) << line;
    EXPECT_EQ(back.codepoint, event.codepoint) << line;
    EXPECT_EQ(back.paths, event.paths) << line;
    EXPECT_TRUE(back.modifiers == event.modifiers) << line;
  }
}

TEST(EventText, RefusesWhatIsNoEvent) {
  for (const char* line : {"", "jump 1 2", "move 1", "move one two", "move nan 2", "button sixth down 1 2",
                           "key NoKey down", "key A down hyper", "char x", "scroll 1 2", "drop 1 2"})
    EXPECT_THROW(event_of_words(split_line(line)), Error) << line;
}

TEST(Facts, AreComparedAsTextOrNumbers) {
  const Session session;
  EXPECT_EQ(fact(session, "frames"), "0");
  EXPECT_EQ(fact(session, "undo_label"), "");
  EXPECT_EQ(fact(session, "question"), "none");
  EXPECT_THROW(fact(session, "weather"), Error);
  EXPECT_TRUE(holds("87", "=", "87"));
  EXPECT_TRUE(holds("87", ">=", "9"));
  EXPECT_FALSE(holds("87", "<=", "9"));
  EXPECT_TRUE(holds("a", "!=", "b"));
  EXPECT_THROW(holds("1", "~", "1"), Error);
}

}  // namespace
}  // namespace understudy::app
