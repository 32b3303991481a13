// Events in, marks and triangles out.
#include "ui/gui/gui.hpp"

#include "render/context/context.hpp"
#include "tests/ui/support/ui_test.hpp"
#include "ui/gui/draw_pass.hpp"
#include "ui/gui/key_chord.hpp"

namespace understudy::ui {
namespace {

using render::InputEvent;
using render::Key;

TEST_F(UiTest, APressAndReleaseInOneFrameIsAClick) {
  int clicks = 0;
  in_window([&](Ui& ui) {
    clicks += ImGui::Button("Play") ? 1 : 0;
    ui.mark("play");
  });
  click("play");
  click("play");
  EXPECT_EQ(clicks, 2);
}

TEST_F(UiTest, ADoubleClickInOneFrameIsADoubleClick) {
  int doubles = 0;
  in_window([&](Ui& ui) {
    ImGui::Button("Play");
    doubles += ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0) ? 1 : 0;
    ui.mark("play");
  });
  double_click("play");
  EXPECT_EQ(doubles, 1);
}

TEST_F(UiTest, ADragInOneFrameEndsAtItsLastPlace) {
  float value = 0;
  in_window([&](Ui& ui) {
    ImGui::SliderFloat("##value", &value, 0, 1);
    ui.mark("value");
  });
  drag("value", 0.2f, 0.8f);
  EXPECT_NEAR(value, 0.8f, 0.05f);
}

TEST_F(UiTest, AModifierLetGoInTheSameFrameStillCounts) {
  char text[32] = "old";
  in_window([&](Ui& ui) {
    ImGui::InputText("##text", text, sizeof text);
    ui.mark("text");
  });
  click("text");
  render::Modifiers control;
  control.control = true;
  std::vector<InputEvent> events(5);  // as a quick hand does it: Ctrl is up before the A
  for (InputEvent& event : events) event.kind = InputEvent::Kind::Key;
  events[0].key = Key::LeftControl, events[0].pressed = true, events[0].modifiers = control;
  events[1].key = Key::A, events[1].pressed = true, events[1].modifiers = control;
  events[2].key = Key::LeftControl;
  events[3].key = Key::A;
  events[4].kind = InputEvent::Kind::Char, events[4].codepoint = U'n';
  play(events);
  EXPECT_STREQ(text, "n");
}

TEST_F(UiTest, TypedTextArrivesInOrderAroundKeys) {
  char text[32] = "";
  in_window([&](Ui& ui) {
    ImGui::InputText("##text", text, sizeof text);
    ui.mark("text");
  });
  click("text");
  std::vector<InputEvent> events;
  const auto write = [&](char32_t c) {
    InputEvent event;
    event.kind = InputEvent::Kind::Char;
    event.codepoint = c;
    events.push_back(event);
  };
  const auto press = [&](Key key) {
    for (const bool pressed : {true, false}) {
      InputEvent event;
      event.kind = InputEvent::Kind::Key;
      event.key = key, event.pressed = pressed;
      events.push_back(event);
    }
  };
  write('a'), write('b'), press(Key::Backspace), write('c'), press(Key::Left), write(U'\u00e9');
  play(events);
  EXPECT_STREQ(text,
               "a\u00e9"
               "c");
}

TEST_F(UiTest, CopiesAndPastesThroughTheHooks) {
  std::string copied;
  Gui with_hooks(
      {[] { return std::string("from outside"); }, [&](const std::string& text) { copied = text; }});
  with_hooks.begin_frame(input);
  ImGui::SetClipboardText("from inside");
  EXPECT_STREQ(ImGui::GetClipboardText(), "from outside");
  with_hooks.end_frame();
  EXPECT_EQ(copied, "from inside");
}

TEST_F(UiTest, LosingTheFocusReleasesEverything) {
  in_window([](Ui&) {});
  InputEvent press;
  press.kind = InputEvent::Kind::Key;
  press.key = Key::W, press.pressed = true;
  play({press});
  const auto held = [&] {
    gui.begin_frame(input);
    const bool down = ImGui::IsKeyDown(static_cast<int>(Key::W));
    gui.end_frame();
    return down;
  };
  EXPECT_TRUE(held());
  InputEvent lost;
  lost.kind = InputEvent::Kind::Focus;
  play({lost});
  EXPECT_FALSE(held());
}

TEST_F(UiTest, MarksSayWhatIsHiddenAndGreyedOut) {
  in_window([](Ui& ui) {
    ImGui::BeginChild("list", {200, 100});
    for (int i = 0; i < 20; ++i) {
      ImGui::Button(std::to_string(i).c_str());
      ui.mark("list." + std::to_string(i));
    }
    ImGui::EndChild();
    const DisabledScope disabled(true);
    ImGui::Button("Off");
    ui.mark("off");
  });
  frame(2);
  EXPECT_TRUE(shown("list.0"));
  EXPECT_FALSE(shown("list.19"));
  EXPECT_FALSE(mark("off").enabled);
  EXPECT_EQ(gui.find("nothing"), nullptr);

  gui.ui().reveal("list.19");
  frame(3);
  EXPECT_TRUE(shown("list.19"));
}

TEST_F(UiTest, GuisFollowEachOther) {
  for (int i = 0; i < 3; ++i) {
    Gui other;
    other.begin_frame({{1200, 800}, 1.f + static_cast<float>(i)});
    EXPECT_FLOAT_EQ(other.ui().px(10), 10.f * static_cast<float>(i + 1));
    other.end_frame();
  }
  in_window([](Ui& ui) {
    ImGui::Button("A");
    ui.mark("a");
  });
  EXPECT_GT(mark("a").rect.width(), 5);
}

TEST_F(UiTest, ScaleMakesLettersAndControlsLarger) {
  in_window([](Ui& ui) {
    ImGui::Button("Play");
    ui.mark("play");
  });
  const Rect at_one = mark("play").rect;
  input.scale = 2, input.size = {1280, 800};
  frame(2);
  const Rect at_two = mark("play").rect;
  EXPECT_NEAR(at_two.width() / at_one.width(), 2, 0.15f);
  EXPECT_NEAR(at_two.height() / at_one.height(), 2, 0.05f);
}

TEST_F(UiTest, ASmallDisplayLimitsTheScale) {
  in_window([](Ui&) {});
  input.scale = 3;
  for (const auto& [size, scale] :
       {std::pair(render::PixelSize{400, 300}, 1.f), std::pair(render::PixelSize{1920, 1080}, 3.f),
        std::pair(render::PixelSize{720, 500}, 2.f)}) {
    input.size = size;
    frame();
    EXPECT_EQ(gui.ui().scale(), scale);
  }
}

TEST_F(UiTest, DigitsAreEquallyWide) {
  in_window([](Ui& ui) {
    for (ImFont* font : {ui.fonts().body, ui.fonts().strong, ui.fonts().small})
      for (ImWchar c = '1'; c <= '9'; ++c) EXPECT_EQ(font->GetCharAdvance(c), font->GetCharAdvance('0'));
  });
  frame();
}

TEST_F(UiTest, TheFontHasTheSignsWeUse) {
  in_window([](Ui& ui) {
    for (const ImWchar c :
         {0xB0, 0xB1, 0xB2, 0xB5, 0xD7, 0xE9, 0x394, 0x3BC, 0x2013, 0x2026, 0x2190, 0x2192, 0x2212, 0x2264})
      for (ImFont* font : {ui.fonts().body, ui.fonts().strong, ui.fonts().small})
        EXPECT_NE(font->FindGlyphNoFallback(c), nullptr) << std::hex << c;
  });
  frame();
}

TEST_F(UiTest, DrawsOnTheNullContextAndLeavesNoNames) {
  in_window([](Ui&) { ImGui::ShowDemoWindow(); });
  const auto context = render::make_offscreen_context({render::ContextKind::Null});
  {
    DrawPass pass;
    const ImDrawData& data = frame(3);
    pass.present(data, gui.atlas(), {0, input.size}, {0, 0, 0, 1});
    EXPECT_GE(render::null_counts().draws, data.CmdListsCount - 1);
    EXPECT_GT(render::null_counts().draws, 2);
    const int draws = render::null_counts().draws;
    pass.present(data, gui.atlas(), {0, input.size}, {0, 0, 0, 1});
    EXPECT_EQ(render::null_counts().draws, draws);  // nothing has changed
  }
  EXPECT_EQ(render::null_counts().live_names, 0);
}

TEST(KeyChord, ReadsModifiersAndSigns) {
  const auto save = chord_of("Ctrl+Shift+S");
  ASSERT_TRUE(save);
  EXPECT_EQ(save->key, Key::S);
  EXPECT_TRUE(save->modifiers.control && save->modifiers.shift && !save->modifiers.alt);
  EXPECT_EQ(chord_of("Space")->key, Key::Space);
  EXPECT_EQ(chord_of("1")->key, Key::Digit1);
  EXPECT_EQ(chord_of("[")->key, Key::LeftBracket);
  EXPECT_TRUE(chord_of("?")->modifiers.shift);
  EXPECT_EQ(chord_of("Ctrl++")->key, Key::Equal);
  EXPECT_FALSE(chord_of("Hyper+S"));
  EXPECT_FALSE(chord_of("Ctrl+"));
  EXPECT_FALSE(chord_of("NoSuchKey"));
}

TEST(KeyChord, PressesModifiersAroundTheKey) {
  const auto events = key_events(*chord_of("Ctrl+Z"));
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[0].key, Key::LeftControl);
  EXPECT_TRUE(events[1].pressed && events[1].modifiers.control && events[1].key == Key::Z);
  EXPECT_FALSE(events[2].pressed);
  EXPECT_TRUE(events[3].key == Key::LeftControl && !events[3].pressed);
}

}  // namespace
}  // namespace understudy::ui
