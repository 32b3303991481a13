// The studio by keys alone: Tab and the ring, menus, lists and dialogs.
#include <imgui_internal.h>

#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/menus.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;
using render::Key;

class KeysTest : public WorkspaceTest {
 protected:
  std::string ring() { return gui.ui().focus().name(); }
  /// Tabs to a control; a failure where it is not reached.
  void tab_to(const std::string& name, render::Modifiers modifiers = {}) {
    for (int i = 0; i < 150 && ring() != name; ++i) key(Key::Tab, modifiers);
    EXPECT_EQ(ring(), name);
  }
  void tap_alt() {
    render::InputEvent down, up;
    down.kind = up.kind = render::InputEvent::Kind::Key;
    down.key = up.key = Key::LeftAlt;
    down.pressed = true, down.modifiers.alt = true;
    play({down, up});
    frame(3);
  }
  /// Letters as keys and as text, one after the other without a frame in between.
  static void add_typed(const std::string& letters, std::vector<render::InputEvent>& events) {
    for (const char letter : letters) {
      render::InputEvent key, text;
      key.kind = render::InputEvent::Kind::Key, text.kind = render::InputEvent::Kind::Char;
      key.key = static_cast<Key>(static_cast<int>(Key::A) + letter - 'a');
      key.pressed = true, text.codepoint = static_cast<char32_t>(letter);
      events.push_back(key), events.push_back(text);
      key.pressed = false;
      events.push_back(key);
    }
  }
  static void add_key(Key key, std::vector<render::InputEvent>& events, render::Modifiers modifiers = {}) {
    render::InputEvent event;
    event.kind = render::InputEvent::Kind::Key, event.key = key, event.modifiers = modifiers;
    event.pressed = true;
    events.push_back(event);
    event.pressed = false;
    events.push_back(event);
  }
};

TEST_F(KeysTest, TabGoesRoundAndBack) {
  key(Key::Tab);
  const std::string first = ring();
  EXPECT_EQ(first, "tools.look");
  key(Key::Tab);
  const std::string second = ring();
  EXPECT_NE(second, first);
  int controls = 1;
  for (; controls < 200 && ring() != first; ++controls) key(Key::Tab);
  EXPECT_EQ(ring(), first) << "after " << controls;
  EXPECT_GT(controls, 20);
  key(Key::Tab), key(Key::Tab, {true});
  EXPECT_EQ(ring(), first);
}

TEST_F(KeysTest, TheRingIsSeenAndGoesWithTheMouse) {
  const auto has_ring = [&] {
    const ImDrawData& drawn = frame();
    for (int i = 0; i < drawn.CmdListsCount; ++i)
      if (std::string(drawn.CmdLists[i]->_OwnerName == nullptr ? "" : drawn.CmdLists[i]->_OwnerName) ==
          "##Foreground")
        return drawn.CmdLists[i]->VtxBuffer.Size > 0;
    return false;
  };
  frame(3);
  EXPECT_FALSE(has_ring());
  key(Key::Tab);
  EXPECT_TRUE(has_ring());
  click("views");
  EXPECT_FALSE(has_ring());
  EXPECT_EQ(ring(), "");
}

TEST_F(KeysTest, EnterAndSpaceUseWhatIsInTheRingAndAreNoShortcuts) {
  tab_to("top.side");
  take_log();
  key(Key::Enter);
  EXPECT_EQ(take_log(), Lines{"panel.show side off"});
  key(Key::Space);
  EXPECT_EQ(take_log(), Lines{"panel.show side on"}) << "and playing does not begin";
  key(Key::Escape);
  key(Key::Space);
  EXPECT_EQ(take_log(), Lines{"playback.toggle"});
}

TEST_F(KeysTest, InAWindowTooLowForMenusAltKeepsNoOtherKeyFromWorking) {
  input.size.height = 60;
  frame(2);
  tap_alt();
  take_log();
  key(Key::Space);
  EXPECT_EQ(take_log(), Lines{"playback.toggle"});
}

TEST_F(KeysTest, WhatIsGreyedOutIsPassedBy) {
  for (int i = 0; i < 200; ++i) {
    key(Key::Tab);
    EXPECT_TRUE(ring().empty() || mark(ring()).enabled) << ring();
  }
}

TEST_F(KeysTest, ATextIsTypedWhenItIsReachedAndKeptWhenItIsLeft) {
  tab_to("timeline.frame");
  take_log();
  type("12");
  key(Key::Tab);
  EXPECT_EQ(take_log(), Lines{"playback.frame 12"});
}

TEST_F(KeysTest, AKeyThatFollowsTabAtOnceIsNotLost) {
  tab_to("timeline.frame", {true});
  key(Key::Tab, {true});
  take_log();
  std::vector<render::InputEvent> events(4);
  events[0].kind = events[1].kind = render::InputEvent::Kind::Key;
  events[0].key = events[1].key = Key::Tab, events[0].pressed = true;
  events[2].kind = events[3].kind = render::InputEvent::Kind::Char;
  events[2].codepoint = U'1', events[3].codepoint = U'4';
  play(events);
  EXPECT_EQ(ring(), "timeline.frame");
  key(Key::Enter);
  EXPECT_EQ(take_log(), Lines{"playback.frame 14"});
}

TEST_F(KeysTest, EscapeLeavesAToolAndNothingElse) {
  key(Key::Escape);
  EXPECT_EQ(take_log(), Lines{});
  session.tool = app::Tool::Paint;
  frame();
  key(Key::Escape);
  EXPECT_EQ(take_log(), Lines{"tool look"});
  session.tool = app::Tool::Paint;
  workspace.open_dialog(session, "settings");
  frame(3);
  key(Key::Escape);
  EXPECT_EQ(take_log(), Lines{}) << "it closes the dialog";
}

TEST_F(KeysTest, ADialogKeepsTheRingToItself) {
  tab_to("tools.look");
  workspace.open_dialog(session, "settings");
  frame(3);
  EXPECT_EQ(ring(), "") << "what is behind waits";
  for (int i = 0; i < 30; ++i) {
    key(Key::Tab);
    EXPECT_EQ(ring().rfind("settings.", 0), 0u) << ring();
  }
  tab_to("settings.close");
  key(Key::Enter);
  frame(2);
  EXPECT_EQ(workspace.dialog(), "");
}

TEST_F(KeysTest, EnterUsesTheButtonInTheRingNotTheUsualOne) {
  session.question = app::Question{};
  frame(3);
  tab_to("unsaved.no");
  key(Key::Enter);
  EXPECT_EQ(take_log(), Lines{"question.answer discard"});
}

TEST_F(KeysTest, AListIsOpenedAndChosenFrom) {
  click("side.tab.1");
  frame(2);
  tab_to("layers.take.colour");
  take_log();
  key(Key::Enter);
  frame(3);
  ASSERT_TRUE(shown("layers.take.colour.1"));
  key(Key::Down);
  key(Key::Enter);
  frame(2);
  EXPECT_EQ(take_log(), Lines{"view.colour take weights"});
  EXPECT_FALSE(shown("layers.take.colour.1"));
  key(Key::Enter);
  frame(3);
  key(Key::Escape);
  frame(2);
  EXPECT_FALSE(shown("layers.take.colour.1"));
  EXPECT_EQ(take_log(), Lines()) << "Escape only closed it";
}

TEST_F(KeysTest, AltOpensTheMenusAndArrowsLeadThroughThem) {
  tap_alt();
  EXPECT_TRUE(shown("menu.document.new"));
  key(Key::Right);
  frame(4);
  EXPECT_TRUE(shown("menu.edit.undo"));
  EXPECT_FALSE(shown("menu.document.new"));
  key(Key::Left), frame(4);
  key(Key::Left), frame(4);
  EXPECT_TRUE(shown("menu.help.keys")) << "round to the last one";
  key(Key::Escape);
  frame(2);
  EXPECT_FALSE(shown("menu.help.keys"));
  EXPECT_EQ(take_log(), Lines{"menu.open"}) << "no frame was stepped to";
}

TEST_F(KeysTest, AMenusEntryIsChosenByKeys) {
  key(Key::V, {false, false, true});
  frame(4);
  ASSERT_TRUE(shown("menu.view.fit"));
  key(Key::Down);  // from the layouts to the front
  key(Key::Enter);
  frame(2);
  EXPECT_EQ(take_log(), (Lines{"menu.open view", "view.preset front"}));
}

TEST_F(KeysTest, AltClosesWhatItOpened) {
  tap_alt();
  EXPECT_TRUE(shown("menu.document.new"));
  tap_alt();
  EXPECT_FALSE(shown("menu.document.new"));
}

TEST_F(KeysTest, AltWithAnotherKeyOpensNothing) {
  key(Key::Digit2, {false, false, true});
  frame(3);
  EXPECT_EQ(take_log(), Lines{"panel.show layers on"});
  EXPECT_FALSE(shown("menu.document.new"));
}

TEST_F(KeysTest, AltOpensTheOneMenuOfANarrowWindow) {
  input.size = {700, 600};
  frame(2);
  key(Key::F, {false, false, true});
  frame(5);
  EXPECT_TRUE(shown("menu.document.new"));
}

TEST_F(KeysTest, EveryMenuHasALetterOfItsOwn) {
  std::string letters;
  for (const Menu& menu : menus(session)) {
    EXPECT_NE(menu.label.find(menu.letter), std::string::npos) << menu.label;
    EXPECT_EQ(letters.find(menu.letter), std::string::npos) << menu.letter;
    letters += menu.letter;
    key(static_cast<Key>(static_cast<int>(Key::A) + (menu.letter | 32) - 'a'), {false, false, true});
    EXPECT_EQ(take_log(), Lines{"menu.open " + menu.name});
    frame(3);
    key(Key::Escape), frame(2);
  }
}

TEST_F(KeysTest, WhatIsTypedAtOnceAfterADialogIsAskedForReachesItsField) {
  frame(3);
  std::vector<render::InputEvent> events;
  add_typed("hturntable", events);  // h opens the palette; t, u, r and n are no shortcuts then
  add_key(Key::Enter, events);
  play(events);
  frame(3);
  EXPECT_EQ(take_log(), (Lines{"help.keys", "view.turntable"}));
  events.clear();
  session.path.clear();
  add_key(Key::S, events, {false, true});
  add_typed("waltz", events);
  add_key(Key::Enter, events);
  play(events);
  frame(3);
  const Lines lines = take_log();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "dialog.open save_as");
  EXPECT_NE(lines[1].find("/waltz.understudy"), std::string::npos) << lines[1];
}

TEST_F(KeysTest, KeysAreADialogsUntilItIsClosedAgain) {
  frame(3);
  std::vector<render::InputEvent> events;
  add_key(Key::Comma, events, {false, true});
  add_key(Key::Escape, events);
  add_key(Key::Space, events);
  play(events);
  frame(3);
  EXPECT_EQ(take_log(), (Lines{"dialog.open settings", "playback.toggle"}));
}

TEST_F(KeysTest, ASampleIsOpenedByTabAndEnter) {
  session = app::Session();
  frame(3);
  tab_to("start.sample.1");
  key(Key::Enter);
  EXPECT_EQ(take_log(), Lines{"open /samples/walk /samples/child.glb"});
}

}  // namespace
}  // namespace understudy::ui
