#include "tests/ui/support/ui_test.hpp"

#include <imgui_internal.h>

#include <utility>

namespace understudy::ui {
namespace {

using render::InputEvent;
using Kind = InputEvent::Kind;

InputEvent move_to(ImVec2 to) {
  InputEvent event;
  event.kind = Kind::MouseMove;
  event.x = to.x, event.y = to.y;
  return event;
}

InputEvent button(ImVec2 at, render::MouseButton which, bool pressed, render::Modifiers modifiers = {}) {
  InputEvent event;
  event.kind = Kind::MouseButton;
  event.x = at.x, event.y = at.y;
  event.button = which, event.pressed = pressed, event.modifiers = modifiers;
  return event;
}

InputEvent key_event(render::Key key, bool pressed, render::Modifiers modifiers) {
  InputEvent event;
  event.kind = Kind::Key;
  event.key = key, event.pressed = pressed, event.modifiers = modifiers;
  return event;
}

/// The modifier keys themselves go down and up around what they modify.
std::vector<InputEvent> with_modifiers(render::Modifiers modifiers, std::vector<InputEvent> events) {
  const std::pair<bool, render::Key> held[] = {{modifiers.shift, render::Key::LeftShift},
                                               {modifiers.control, render::Key::LeftControl},
                                               {modifiers.alt, render::Key::LeftAlt}};
  for (const auto& [down, key] : held) {
    if (!down) continue;
    events.insert(events.begin(), key_event(key, true, modifiers));
    events.push_back(key_event(key, false, {}));
  }
  return events;
}

}  // namespace

void UiTest::in_window(std::function<void(Ui&)> widgets) {
  content = [widgets = std::move(widgets)](Ui& ui) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    if (ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBringToFrontOnFocus))
      widgets(ui);
    ImGui::End();
  };
}

const ImDrawData& UiTest::frame(int count) {
  const ImDrawData* data = nullptr;
  for (int i = 0; i < count; ++i) {
    gui.begin_frame(input);
    content(gui.ui());
    data = &gui.end_frame();
  }
  return *data;
}

void UiTest::play(std::vector<InputEvent> events) {
  gui.begin_frame(input, events);
  content(gui.ui());
  gui.end_frame();
  while (gui.pending()) frame();
  frame();
}

Mark UiTest::mark(const std::string& name) {
  if (gui.find(name) == nullptr) frame(2);  // windows appear after a frame
  const Mark* found = gui.find(name);
  if (found != nullptr) return *found;
  ADD_FAILURE() << "nothing is called " << name;
  return {name, {{-9, -9}, {-8, -8}}, {}, false};
}

bool UiTest::shown(const std::string& name) {
  const Mark* found = gui.find(name);
  return found != nullptr && !found->visible.empty();
}

void UiTest::click(const std::string& name, render::MouseButton which) {
  const Mark target = mark(name);
  EXPECT_FALSE(target.visible.empty()) << name << " is not to be seen";
  EXPECT_TRUE(target.enabled) << name << " is greyed out";
  click(target.visible.at(0.5f, 0.5f), which);
}

void UiTest::click(ImVec2 at, render::MouseButton which, render::Modifiers modifiers) {
  play(with_modifiers(
      modifiers, {move_to(at), button(at, which, true, modifiers), button(at, which, false, modifiers)}));
}

void UiTest::double_click(const std::string& name) {
  const ImVec2 at = mark(name).visible.at(0.5f, 0.5f);
  const auto left = render::MouseButton::Left;
  play({move_to(at), button(at, left, true), button(at, left, false), button(at, left, true),
        button(at, left, false)});
}

void UiTest::hover(const std::string& name, float x, float y) {
  play({move_to(mark(name).visible.at(x, y))});
  frame(60);
}

void UiTest::drag(const std::string& name, float from, float to) {
  const Mark target = mark(name);
  drag(target.rect.at(from, 0.5f), target.rect.at(to, 0.5f));
}

void UiTest::drag(ImVec2 from, ImVec2 to, render::Modifiers modifiers, render::MouseButton which) {
  const ImVec2 half((from.x + to.x) / 2, (from.y + to.y) / 2);
  play(with_modifiers(modifiers, {move_to(from), button(from, which, true, modifiers), move_to(half),
                                  move_to(to), button(to, which, false, modifiers)}));
}

void UiTest::scroll(const std::string& name, float notches, render::Modifiers modifiers) {
  const ImVec2 at = mark(name).visible.at(0.5f, 0.5f);
  InputEvent event = move_to(at);
  event.kind = Kind::Scroll;
  event.dy = notches, event.modifiers = modifiers;
  play(with_modifiers(modifiers, {move_to(at), event}));
}

void UiTest::type(const std::string& text) {
  std::vector<InputEvent> events;
  for (const unsigned char c : text) {  // ASCII is enough for tests
    InputEvent event;
    event.kind = Kind::Char;
    event.codepoint = c;
    events.push_back(event);
  }
  play(events);
}

void UiTest::key(render::Key key, render::Modifiers modifiers) {
  play(with_modifiers(modifiers, {key_event(key, true, modifiers), key_event(key, false, modifiers)}));
}

}  // namespace understudy::ui
