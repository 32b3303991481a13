#include "ui/widgets/dialogs.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "ui/gui/gui.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

bool enter_pressed() {
  return key_pressed(render::Key::Enter, false) || key_pressed(render::Key::KeypadEnter, false);
}

/// A row of buttons, right-aligned, the main one last.
struct Choice {
  Answer answer;
  std::string name, label;
  ButtonLook look;
};

Answer draw_choices(Ui& ui, const std::vector<Choice>& choices) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  float all = -gap;
  const auto width = [&ui](const Choice& choice) {
    return std::max(ui.px(88), ImGui::CalcTextSize(choice.label.c_str()).x + ui.px(28));
  };
  for (const Choice& choice : choices) all += width(choice) + gap;
  ImGui::Dummy({0, ui.px(4)});
  ImGui::SetCursorPosX(
      std::max(ImGui::GetCursorPosX(), ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - all));
  Answer answer = Answer::None;
  for (size_t i = 0; i < choices.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    ButtonOptions options;
    options.look = choices[i].look, options.width = width(choices[i]);
    if (button(ui, choices[i].name, choices[i].label, options)) answer = choices[i].answer;
  }
  return answer;
}

constexpr float kToastHeight = 34, kToastPad = 8;  // at scale 1

/// What fits on the one line of a toast.
struct ToastLine {
  std::string words;
  float width = 0, button = 0, also = 0;  ///< pixels, of the whole and of the buttons
};
ToastLine toast_line(Ui& ui, const Toast& toast, const Rect& area) {
  ToastLine line;
  const auto width = [&](const std::string& label) {
    return label.empty() ? 0 : ImGui::CalcTextSize(label.c_str()).x + ui.px(28);
  };
  line.button = width(toast.button), line.also = width(toast.also);
  const float gap = ui.px(8), around = 2 * ui.px(kToastPad) + ImGui::GetTextLineHeight() + gap +
                                       (line.button > 0 ? line.button + gap : 0) +
                                       (line.also > 0 ? line.also + gap : 0);
  line.words = cut_to(toast.sentence, std::max(ui.px(40), area.width() - ui.px(20) - around));
  line.width = std::ceil(ImGui::CalcTextSize(line.words.c_str()).x + around);
  return line;
}

/// At the bottom right of the area; where that lies on `avoid`, left of it, else above it.
Rect place_toast(const ImVec2& size, const Rect& area, const Rect& avoid, float gap) {
  Rect place{{area.max.x - gap - size.x, area.max.y - size.y}, {area.max.x - gap, area.max.y}};
  if (intersection(place, avoid).empty()) return place;
  const float left = avoid.min.x - gap - size.x, top = avoid.min.y - gap - size.y;
  if (left >= area.min.x)
    place = {{left, place.min.y}, {left + size.x, place.max.y}};
  else if (top >= area.min.y)
    place = {{place.min.x, top}, {place.max.x, top + size.y}};
  return place;
}

struct ToastToDraw {
  const std::string& name;
  const Toast& toast;
  const ToastLine& line;
  const Rect& place;
  int number;
};
void draw_toast(Ui& ui, const ToastToDraw& one, ToastUse& use) {
  ImGui::SetNextWindowPos(one.place.min);
  ImGui::SetNextWindowSize({one.place.width(), one.place.height()});
  const ColorScope background(ImGuiCol_WindowBg, ui.theme().raised);
  const float middle = (one.place.height() - ImGui::GetTextLineHeight()) / 2;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(kToastPad), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin(("##" + one.name).c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
  const bool good = one.toast.kind == NoticeKind::Good;
  ImGui::SetCursorPosY(middle);
  icon_label(ui, good ? Icon::Check : Icon::Warning, good ? ui.theme().good : ui.theme().warning);
  ImGui::SameLine(0, ui.px(8));
  ImGui::TextUnformatted(one.line.words.c_str());
  if (one.line.words != one.toast.sentence) tooltip(ui, one.toast.sentence);
  float right = one.place.width() - ui.px(kToastPad);
  const auto offer = [&](const char* name, const std::string& label, float width, int& clicked) {
    if (width <= 0) return;
    ImGui::SameLine(right - width);
    ImGui::SetCursorPosY((one.place.height() - ImGui::GetFrameHeight()) / 2);
    ButtonOptions options;
    options.width = width;
    if (button(ui, one.name + name, label, options)) clicked = one.number;
    right -= width + ui.px(8);
  };
  offer(".also", one.toast.also, one.line.also, use.also);
  offer(".offer", one.toast.button, one.line.button, use.offered);
  ui.mark(one.name, one.place);
  const bool hovered = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
  if (hovered) use.hovered = one.number;
  if (hovered && ImGui::IsMouseClicked(0) && !ImGui::IsAnyItemHovered()) use.clicked = one.number;
  ImGui::End();
}

}  // namespace

ToastUse draw_toasts(Ui& ui, const std::vector<Toast>& toasts, const Rect& over, const Rect& avoid) {
  const Rect area = over.empty() ? Rect{{0, 0}, ImGui::GetIO().DisplaySize} : over;
  ToastUse use;
  float bottom = area.max.y - ui.px(6);
  for (size_t k = toasts.size(); k-- > 0;) {
    const std::string name = "notice." + std::to_string(toasts.size() - 1 - k);
    const ToastLine line = toast_line(ui, toasts[k], area);
    const Rect place =
        place_toast({line.width, ui.px(kToastHeight)}, {area.min, {area.max.x, bottom}}, avoid, ui.px(8));
    const ImGuiWindow* const dialog = ImGui::GetTopMostPopupModal();
    const bool is_in_the_way =
        dialog != nullptr && !intersection(place, {dialog->Rect().Min, dialog->Rect().Max}).empty();
    if (!is_in_the_way) draw_toast(ui, {name, toasts[k], line, place, static_cast<int>(k)}, use);
    bottom = place.min.y - ui.px(6);
  }
  return use;
}

bool begin_dialog(Ui& ui, const std::string& name, const std::string& title, float width, float height) {
  const bool inside_another = ImGui::GetCurrentContext()->BeginPopupStack.Size > 0, fixed = height > 0;
  if (!inside_another && !ui.claim_dialog(name)) return false;
  if (!ImGui::IsPopupOpen(name.c_str())) ImGui::OpenPopup(name.c_str());
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(ui.px(width), display.x - ui.px(16)),
                            fixed ? std::min(ui.px(height), display.y - ui.px(16)) : 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                      fixed ? ImVec2(ui.px(14), ui.px(12)) : ImVec2(ui.px(18), ui.px(16)));
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                           ImGuiWindowFlags_NoSavedSettings;
  if (fixed) flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  const bool open = ImGui::BeginPopupModal(name.c_str(), nullptr, flags);
  ImGui::PopStyleVar();
  if (!open) return false;
  const FontScope strong(ui.fonts().strong);
  ImGui::TextUnformatted(title.c_str());
  return true;
}

void end_dialog() {
  ImGui::EndPopup();
}

Answer ask(Ui& ui, const std::string& name, const QuestionWords& question) {
  if (!begin_dialog(ui, name, question.title, 420)) return Answer::None;
  paragraph(question.sentence);
  std::vector<Choice> choices;
  if (!question.cancel.empty())
    choices.push_back({Answer::Cancel, name + ".cancel", question.cancel, ButtonLook::Plain});
  if (!question.no.empty()) choices.push_back({Answer::No, name + ".no", question.no, ButtonLook::Plain});
  choices.push_back(
      {Answer::Yes, name + ".yes", question.yes, question.dangerous ? ButtonLook::Danger : ButtonLook::Main});
  Answer answer = draw_choices(ui, choices);
  if (answer == Answer::None && !ImGui::IsWindowAppearing()) {
    if (!question.dangerous && enter_pressed()) answer = Answer::Yes;
    if (key_pressed(render::Key::Escape, false)) answer = Answer::Cancel;
  }
  if (answer != Answer::None) ImGui::CloseCurrentPopup();
  end_dialog();
  return answer;
}

bool show_error(Ui& ui, const std::string& name, const std::string& sentence, const std::string& details) {
  if (!begin_dialog(ui, name, "That did not work", 480)) return false;
  icon_label(ui, Icon::Warning, ui.theme().danger);
  ImGui::SameLine();
  paragraph(sentence);
  const Answer answer = draw_choices(ui, {{Answer::No, name + ".copy", "Copy details", ButtonLook::Plain},
                                          {Answer::Yes, name + ".close", "Close", ButtonLook::Main}});
  if (answer == Answer::No) ImGui::SetClipboardText((sentence + "\n" + details).c_str());
  const bool closed = answer == Answer::Yes || (!ImGui::IsWindowAppearing() &&
                                                (enter_pressed() || key_pressed(render::Key::Escape, false)));
  if (closed) ImGui::CloseCurrentPopup();
  end_dialog();
  return closed;
}

}  // namespace understudy::ui
