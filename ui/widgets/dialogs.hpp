// Notices, questions and error dialogs.
#pragma once

#include <string>
#include <vector>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

enum class NoticeKind { Good, Warning };

/// Sentences shown for some seconds, three at most: "Saved walk.understudy". Plain data; the
/// application keeps one and draws it last.
class Notices {
 public:
  struct Toast {
    std::string sentence;
    NoticeKind kind = NoticeKind::Good;
    float seconds_left = 0;
    std::string button{}, command{};  ///< what it offers, and what draw() then returns; empty: nothing
  };
  void add(Toast notice);
  /// Call once a frame, outside any window. A notice stays while the pointer is on it; a click removes it.
  /// The newest is on top, at the top right of `over` (empty: of the window), and marked notice.0, its button
  /// notice.0.offer. Returns the command of a button that was clicked, else "".
  std::string draw(Ui& ui, const Rect& over = {});
  bool empty() const { return notices_.empty(); }

 private:
  std::vector<Toast> notices_;
};

enum class Answer { None, Yes, No, Cancel };

struct QuestionWords {
  std::string title;
  std::string sentence;
  std::string yes = "OK";
  std::string no;                 ///< a second way on ("Don't save"); none when empty
  std::string cancel = "Cancel";  ///< none when empty
  bool dangerous = false;         ///< yes destroys something: it is red, and Enter does not choose it
};
/// Call every frame until it answers, outside any window. Enter is yes,
/// Escape is cancel. Buttons are marked NAME.yes, NAME.no, NAME.cancel.
Answer ask(Ui& ui, const std::string& name, const QuestionWords& question);

/// An error as one sentence, with "Copy details". Call every frame until it returns true: closed. Marked
/// NAME.close and NAME.copy.
bool show_error(Ui& ui, const std::string& name, const std::string& sentence, const std::string& details);

/// Begins a dialog in the middle of the display, which greys out everything else. When true, end it with
/// end_dialog(). Width and height at scale 1, cut to the display; height 0: what it holds.
bool begin_dialog(Ui& ui, const std::string& name, const std::string& title, float width, float height = 0);
void end_dialog();

}  // namespace understudy::ui
