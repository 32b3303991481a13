// Notices, questions and error dialogs.
#pragma once

#include <string>
#include <vector>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

enum class NoticeKind { Good, Warning };

/// A sentence with what can be done about it: "Saved walk.understudy".
struct Toast {
  std::string sentence;
  NoticeKind kind = NoticeKind::Good;
  std::string button{};  ///< empty: nothing
  std::string also{};    ///< a second button
};
/// Of which toast, by its number; below 0: of none.
struct ToastUse {
  int hovered = -1;
  int clicked = -1;  ///< away
  int offered = -1;  ///< its button was clicked
  int also = -1;     ///< its second button was clicked
};
/// Call once a frame, outside any window. A line each at the bottom right of `over` (empty: of the window),
/// beside `avoid` where there is room, the last at the bottom.
/// The last is marked notice.0, its buttons notice.0.offer and
/// notice.0.also.
ToastUse draw_toasts(Ui& ui, const std::vector<Toast>& toasts, const Rect& over = {}, const Rect& avoid = {});

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
