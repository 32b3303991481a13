#include "ui/widgets/dialogs.hpp"

#include <imgui_internal.h>

#include <algorithm>

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

}  // namespace

void Notices::add(Toast notice) {
  notices_.push_back(std::move(notice));
  if (notices_.size() > 3) notices_.erase(notices_.begin());
}

std::string Notices::draw(Ui& ui, const Rect& over) {
  std::string chosen;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const Rect area = over.empty() ? Rect{{0, 0}, display} : over;
  const float room = std::max(ui.px(120), std::min(ui.px(420), area.width() - ui.px(20)));
  float bottom = area.max.y - ui.px(10);
  for (size_t k = notices_.size(); k-- > 0;) {
    Toast& notice = notices_[k];
    const std::string name = "notice." + std::to_string(notices_.size() - 1 - k);
    ImGui::SetNextWindowPos({area.max.x - ui.px(10), bottom}, ImGuiCond_Always, {1, 1});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {room, FLT_MAX});
    const ColorScope background(ImGuiCol_WindowBg, ui.theme().raised);
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, std::clamp(notice.seconds_left / 0.3f, 0.05f, 1.f));
    ImGui::Begin(("##" + name).c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
    const bool good = notice.kind == NoticeKind::Good;
    icon_label(ui, good ? Icon::Check : Icon::Warning, good ? ui.theme().good : ui.theme().warning);
    ImGui::SameLine();
    ImGui::PushTextWrapPos(room - ui.px(20));
    ImGui::TextUnformatted(notice.sentence.c_str());
    ImGui::PopTextWrapPos();
    bool offered = false;
    if (!notice.button.empty()) {
      offered = button(ui, name + ".offer", notice.button);
      if (offered) chosen = notice.command, notice.seconds_left = 0;
    }
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ui.mark(name, {at, {at.x + size.x, at.y + size.y}});
    const bool hovered = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    if (!hovered) notice.seconds_left -= ImGui::GetIO().DeltaTime;
    if (hovered && ImGui::IsMouseClicked(0) && !ImGui::IsAnyItemHovered()) notice.seconds_left = 0;
    bottom -= size.y + ui.px(8);
    ImGui::End();
    ImGui::PopStyleVar();
  }
  notices_.erase(
      std::remove_if(notices_.begin(), notices_.end(), [](const Toast& n) { return n.seconds_left <= 0; }),
      notices_.end());
  return chosen;
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
  ImGui::TextWrapped("%s", question.sentence.c_str());
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
  ImGui::TextWrapped("%s", sentence.c_str());
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
