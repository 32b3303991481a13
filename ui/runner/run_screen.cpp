#include "ui/runner/run_screen.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

using app::QuestionKind;
using app::RunScreen;
using app::StudyQuestion;
using app::StudyRun;
using render::Key;

constexpr float kColumn = 560, kTall = 10;  // width of what is read; between lines; at scale 1

struct Screen {
  Ui& ui;
  RunScreenState& state;
  const RunFrame& frame;
  StudyRun& run() const { return frame.run; }
};

void gap(Ui& ui, float height) {
  ImGui::Dummy({0, ui.px(height)});
}

void to_middle(float width) {
  ImGui::SetCursorPosX(std::floor((ImGui::GetWindowWidth() - width) / 2));
}

/// Lines in the current font, each in the middle of the window.
void centred(const std::string& text, float room) {
  for (const std::string& line : split(in_lines(text, room), '\n')) {
    to_middle(ImGui::CalcTextSize(line.c_str()).x);
    ImGui::TextUnformatted(line.c_str());
  }
}

void title(Ui& ui, const std::string& text) {
  const FontScope large(ui.fonts().title);
  centred(text, ui.px(kColumn));
  gap(ui, kTall);
}

/// A button that is seen on any grey.
bool outlined_button(Ui& ui, const std::string& name, const std::string& label,
                     const ButtonOptions& options) {
  const bool clicked = button(ui, name, label, options);
  ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                      color(ui.theme().text_faint), ui.px(4));
  return clicked;
}

bool centred_button(Ui& ui, const std::string& name, const std::string& label, const std::string& key) {
  ButtonOptions options;
  options.look = ButtonLook::Main, options.shortcut = key, options.width = ui.px(180);
  to_middle(options.width);
  return button(ui, name, label, options) || key_pressed(Key::Enter, false);
}

/// Starts what is drawn next so that it lies in the middle of the window's height, as high as last time.
class MiddleScope {
 public:
  MiddleScope(Ui& ui, const char* name) : height_(ui.state<float>(ImGui::GetID(name))) {
    ImGui::SetCursorPosY(std::max(ui.px(48), std::floor((ImGui::GetWindowHeight() - height_) / 2)));
    top_ = ImGui::GetCursorPosY();
  }
  ~MiddleScope() { height_ = ImGui::GetCursorPosY() - top_; }
  MiddleScope(const MiddleScope&) = delete;
  MiddleScope& operator=(const MiddleScope&) = delete;

 private:
  float& height_;
  float top_ = 0;
};

std::string of_count(const StudyRun& run) {
  return printed("%s %d of %d", run.trial().is_practice ? "Practice" : "Trial", run.number(), run.count());
}

void draw_welcome(const Screen& s) {
  const MiddleScope middle(s.ui, "welcome");
  const StudyRun& run = s.run();
  title(s.ui, run.is_resumed() ? "Welcome back" : "Welcome");
  const float room = s.ui.px(kColumn);
  const std::string& consent = run.study().consent;
  std::string words =
      "Watch each clip to its end, then answer what is asked about it. There are no right or wrong "
      "impressions.";
  if (run.trial().is_practice) words += " The first clips are for practice; they do not count.";
  if (run.is_resumed()) words = "You go on where you left off: " + of_count(run) + ".";
  if (!run.is_resumed() && !consent.empty()) {
    centred(consent, room);
    gap(s.ui, kTall);
  }
  centred(words, room);
  gap(s.ui, kTall);
  {
    const ColorScope dim(ImGuiCol_Text, s.ui.theme().text_dim);
    centred("Mouse or number keys answer, Enter goes on, R plays the clip again, Escape leaves.", room);
    centred("Participant " + run.participant(), room);
  }
  gap(s.ui, 2 * kTall);
  const char* const on = run.is_resumed() ? "Go on" : consent.empty() ? "Begin" : "I agree, begin";
  if (centred_button(s.ui, "run.begin", on, "Enter")) s.run().begin();
}

void draw_pause(const Screen& s) {
  const MiddleScope middle(s.ui, "pause");
  const StudyRun& run = s.run();
  const bool begins = run.number() == 1;
  title(s.ui, begins ? "Practice is over" : "Time for a break");
  centred(begins ? "From now on your answers count."
                 : printed("%d of %d trials are done. Go on when you like.", run.number() - 1, run.count()),
          s.ui.px(kColumn));
  gap(s.ui, 2 * kTall);
  if (centred_button(s.ui, "run.begin", begins ? "Begin" : "Go on", "Enter")) s.run().begin();
}

void draw_end(const Screen& s) {
  const MiddleScope middle(s.ui, "end");
  title(s.ui, "Thank you");
  centred("All trials are done, and your answers are saved.", s.ui.px(kColumn));
  gap(s.ui, 2 * kTall);
  if (centred_button(s.ui, "run.leave", "Close", "Enter")) s.state.leaves = true;
}

/// As large as it can be, never larger than it is.
void draw_clip(const Screen& s) {
  const ClipPicture& clip = s.frame.clip;
  if (clip.texture == nullptr) return;
  const ImVec2 room = ImGui::GetWindowSize();
  const float shrink = std::min({1.f, room.x / clip.width, room.y / clip.height});
  const ImVec2 size{std::floor(clip.width * shrink), std::floor(clip.height * shrink)};
  ImGui::SetCursorPos({std::floor((room.x - size.x) / 2), std::floor((room.y - size.y) / 2)});
  ImGui::Image(clip.texture, size);
  s.ui.mark("run.clip");
}

void draw_progress(const Screen& s) {
  const StudyRun& run = s.run();
  Ui& ui = s.ui;
  const float width = ui.px(260), height = ui.px(4), top = ui.px(34);
  const ImVec2 left{std::floor((ImGui::GetWindowWidth() - width) / 2), top};
  const float done = static_cast<float>(run.number() - 1) / static_cast<float>(run.count());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(left, {left.x + width, top + height}, color(ui.theme().field), height / 2);
  if (done > 0)
    list.AddRectFilled(left, {left.x + done * width, top + height}, color(ui.theme().accent), height / 2);
  ImGui::SetCursorPosY(ui.px(10));
  const FontScope small(ui.fonts().small);
  const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
  centred(of_count(run), width);
}

/// The first question that is not answered; `otherwise` where all are.
int first_open(const StudyRun& run, int otherwise) {
  const std::vector<std::string>& chosen = run.chosen();
  const auto at = std::find(chosen.begin(), chosen.end(), "");
  return at == chosen.end() ? otherwise : static_cast<int>(at - chosen.begin());
}

void choose(const Screen& s, int question, const std::string& answer) {
  s.state.problem = failure_of([&] { s.run().choose(question, answer, s.frame.now_s); });
  s.state.marked = first_open(s.run(), question);
}

/// A bar beside the question that the keys are about.
void draw_mark(const Screen& s, float left, float top) {
  const float bottom = ImGui::GetCursorScreenPos().y - ImGui::GetStyle().ItemSpacing.y;
  ImGui::GetWindowDrawList()->AddRectFilled({left - s.ui.px(14), top}, {left - s.ui.px(11), bottom},
                                            color(s.ui.theme().accent), s.ui.px(1.5f));
}

/// The words at the ends of a scale, below its first and last point.
void draw_ends(Ui& ui, const StudyQuestion& question, float left, float width) {
  const FontScope small(ui.fonts().small);
  const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
  const float half = std::floor(width / 2) - ui.px(8);
  const std::string low = in_lines(question.low, half), high = in_lines(question.high, half);
  const float top = ImGui::GetCursorPosY();
  ImGui::SetCursorPosX(left);
  ImGui::TextUnformatted(low.c_str());
  const float below = ImGui::GetCursorPosY();
  ImGui::SetCursorPos({left + width - ImGui::CalcTextSize(high.c_str()).x, top});
  ImGui::TextUnformatted(high.c_str());
  ImGui::SetCursorPosY(std::max(below, ImGui::GetCursorPosY()));
}

/// In columns of one width, as many as the words leave room for.
void draw_answers(const Screen& s, int index, const StudyQuestion& question, float left) {
  const std::vector<std::string> offered = app::offered_answers(question);
  const float space = s.ui.px(8), room = s.ui.px(kColumn);
  float widest = s.ui.px(40);
  for (const std::string& one : offered)
    widest = std::max(widest, ImGui::CalcTextSize(one.c_str()).x + s.ui.px(24));
  const int most = std::max(1, static_cast<int>((room + space) / (widest + space)));
  const int count = static_cast<int>(offered.size()), rows = (count + most - 1) / most;
  const int columns = (count + rows - 1) / rows;
  const float step = (room + space) / static_cast<float>(columns);
  for (int i = 0; i < count; ++i) {
    if (i % columns != 0) ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(left + static_cast<float>(i % columns) * step);
    const std::string name = printed("run.question.%d.%d", index + 1, i + 1);
    ButtonOptions options;
    options.width = step - space;
    options.look = s.run().chosen()[index] == offered[i] ? ButtonLook::Main : ButtonLook::Plain;
    if (outlined_button(s.ui, name, offered[i], options)) choose(s, index, offered[i]);
  }
  if (question.kind == QuestionKind::Likert) draw_ends(s.ui, question, left, room);
}

void draw_question(const Screen& s, int index) {
  const StudyQuestion& question = s.run().study().questions[s.run().trial().questions[index]];
  const float room = s.ui.px(kColumn), left = std::floor((ImGui::GetWindowWidth() - room) / 2);
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const float screen_left = ImGui::GetWindowPos().x + left;
  ImGui::SetCursorPosX(left);
  {
    const FontScope strong(s.ui.fonts().strong);
    ImGui::TextUnformatted(in_lines(question.text, room).c_str());
  }
  draw_answers(s, index, question, left);
  if (index == s.state.marked && s.run().chosen().size() > 1) draw_mark(s, screen_left, origin.y);
  gap(s.ui, 2 * kTall);
}

void confirm(const Screen& s) {
  s.state.wants_all = !s.run().is_complete();
  if (s.state.wants_all) {
    s.state.marked = first_open(s.run(), 0);
    return;
  }
  s.state.problem = failure_of([&] { s.run().confirm(); });
  if (s.state.problem.empty()) s.state.marked = 0;
}

/// What keeps the participant here, if anything does.
void draw_obstacle(const Screen& s) {
  const bool is_unsaved = !s.state.problem.empty();
  if (!is_unsaved && (!s.state.wants_all || s.run().is_complete())) return;
  const ColorScope danger(ImGuiCol_Text, s.ui.theme().danger);
  centred(is_unsaved ? "Your answers could not be saved: " + s.state.problem +
                           ". They are kept here; tell the experimenter, then continue."
                     : "Please answer every question.",
          s.ui.px(kColumn));
  gap(s.ui, kTall);
}

void take_keys(const Screen& s) {
  const int count = static_cast<int>(s.run().chosen().size());
  if (key_pressed(Key::Down)) s.state.marked = std::min(count - 1, s.state.marked + 1);
  if (key_pressed(Key::Up)) s.state.marked = std::max(0, s.state.marked - 1);
  const StudyQuestion& question = s.run().study().questions[s.run().trial().questions[s.state.marked]];
  const std::vector<std::string> offered = app::offered_answers(question);
  for (int i = 0; i < std::min<int>(9, static_cast<int>(offered.size())); ++i)
    for (const Key first : {Key::Digit1, Key::Keypad1})
      if (key_pressed(static_cast<Key>(static_cast<int>(first) + i), false)) {
        choose(s, s.state.marked, offered[i]);
        return;  // the mark has moved
      }
}

void draw_questions(const Screen& s) {
  Ui& ui = s.ui;
  take_keys(s);
  {
    const MiddleScope middle(ui, "questions");
    for (size_t i = 0; i < s.run().chosen().size(); ++i) draw_question(s, static_cast<int>(i));
    draw_obstacle(s);
    ButtonOptions again, on;
    again.shortcut = "R", again.width = on.width = ui.px(160);
    on.shortcut = "Enter", on.look = ButtonLook::Main, on.disabled = !s.run().is_complete();
    to_middle(again.width + on.width + ui.px(12));
    const bool replays = outlined_button(ui, "run.replay", "Play again", again) || key_pressed(Key::R, false);
    ImGui::SameLine(0, ui.px(12));
    const bool goes_on = button(ui, "run.continue", "Continue", on) || key_pressed(Key::Enter, false);
    if (replays)
      s.run().replay();
    else if (goes_on)
      confirm(s);
  }
}

void ask_to_leave(const Screen& s) {
  const MiddleScope middle(s.ui, "leave");
  title(s.ui, "Leave the study?");
  centred("What you have answered is saved. You can go on later with this trial.", s.ui.px(kColumn));
  gap(s.ui, 2 * kTall);
  ButtonOptions stay, leave;
  stay.look = ButtonLook::Main, stay.width = leave.width = s.ui.px(140), stay.shortcut = "Enter";
  to_middle(2 * stay.width + s.ui.px(12));
  if (button(s.ui, "run.stay", "Stay", stay) || key_pressed(Key::Enter, false)) s.state.asks_to_leave = false;
  ImGui::SameLine(0, s.ui.px(12));
  if (outlined_button(s.ui, "run.leave", "Leave", leave)) s.state.leaves = true;
}

void draw_current(const Screen& s) {
  const RunScreen screen = s.run().screen();
  if (s.state.asks_to_leave) return ask_to_leave(s);
  switch (screen) {
    case RunScreen::Welcome:
      return draw_welcome(s);
    case RunScreen::Pause:
      return draw_pause(s);
    case RunScreen::End:
      return draw_end(s);
    case RunScreen::Clip:
      return draw_clip(s);
    case RunScreen::Questions:
      draw_progress(s);
      return draw_questions(s);
  }
}

}  // namespace

ThemeKind theme_upon(const Vec3& background) {
  return background.dot(Vec3(0.2126f, 0.7152f, 0.0722f)) > 0.5f ? ThemeKind::Light : ThemeKind::Dark;
}

void draw_run_screen(Ui& ui, RunScreenState& state, const RunFrame& frame) {
  const Vec3& back = frame.run.study().picture.background;
  const ColorScope ground(ImGuiCol_WindowBg, {back.x(), back.y(), back.z(), 1});
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("##run", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar(3);
  const Screen screen{ui, state, frame};
  if (key_pressed(Key::Escape, false)) {
    if (frame.run.screen() == RunScreen::End) state.leaves = true;
    state.asks_to_leave = !state.asks_to_leave;
  }
  draw_current(screen);
  ImGui::End();
}

}  // namespace understudy::ui
