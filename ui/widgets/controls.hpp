// Buttons, switches, numbers, rows and sections. Each takes a name: it is the widget's id and its mark.
#pragma once

#include <cfloat>
#include <string>
#include <vector>

#include "ui/gui/ui.hpp"
#include "ui/widgets/icons.hpp"

namespace understudy::ui {

/// Explains the last item when the pointer rests on it, with its keys: "Play  Space". Works on greyed-out
/// items, too.
void tooltip(Ui& ui, const std::string& text, const std::string& shortcut = {});

struct IconButtonOptions {
  std::string tooltip, shortcut;
  bool active = false;    ///< on, chosen
  bool disabled = false;  ///< the tooltip should then explain why
  float size = 28;        ///< its side at scale 1
};
/// True when clicked.
bool icon_button(Ui& ui, const std::string& name, Icon icon, const IconButtonOptions& options = {});

enum class ButtonLook {
  Plain,
  Main,    ///< the usual choice
  Danger,  ///< destroys something
  Quiet    ///< no box until the pointer is over it
};
struct ButtonOptions {
  ButtonLook look = ButtonLook::Plain;
  std::string tooltip, shortcut;
  bool disabled = false;
  float width = 0;  ///< pixels; 0: as wide as its text; negative: up to so far from the right edge
};
bool button(Ui& ui, const std::string& name, const std::string& label, const ButtonOptions& options = {});

/// A switch with its label to the right. True when it changed.
bool toggle(Ui& ui, const std::string& name, const std::string& label, bool& on);

/// One of a few, beside each other, over the width that is left. True when the choice changed. Choice i is
/// marked NAME.i too. tips: what each choice means, when the pointer rests on it.
bool segmented(Ui& ui, const std::string& name, const std::vector<std::string>& choices, int& chosen,
               const std::vector<std::string>& tips = {});

/// One of many, from a list that drops down; over the width that is left. True when the choice changed. While
/// open, choice i is marked NAME.i. tips: as of segmented().
bool dropdown(Ui& ui, const std::string& name, const std::vector<std::string>& choices, int& chosen,
              const std::vector<std::string>& tips = {});

struct NumberOptions {
  float min = -FLT_MAX, max = FLT_MAX;
  float speed = 0.01f;  ///< a pixel of dragging
  const char* format = "%.2f";
  float initial = 0;        ///< what its reset button, shown while the value differs, goes back to
  bool resettable = false;  ///< whether there is that button
};
/// A number to drag, or to type after a double click; over the width that is left. True while it changes;
/// the reset is marked NAME.reset.
bool number(Ui& ui, const std::string& name, float& value, const NumberOptions& options = {});

/// A text field, with a grey hint while it is empty. True when it changed.
bool text_field(Ui& ui, const std::string& name, std::string& text, const std::string& hint = {});

/// Begins a row: the label on the left, what follows fills the right. `label_width` pixels, 0: 40 %.
void row(Ui& ui, const std::string& label, const std::string& explanation = {}, float label_width = 0);
/// A row of text: label and value. The value is cut with "…" where it does not fit, whole in a tooltip.
void row_text(Ui& ui, const std::string& label, const std::string& value);

/// A header that opens and closes what follows; true when open. Remembered by the Ui.
bool section(Ui& ui, const std::string& name, const std::string& title, bool open_at_first = true);

/// Text in the body font, cut with "…" at `width` pixels (0: what is left), the whole then in a tooltip.
void text_cut(Ui& ui, const std::string& text, float width = 0);
/// The text cut so that it takes at most `width` pixels in the current font.
std::string cut_to(const std::string& text, float width);
/// The same for a name, cut in its middle: names of takes and files often differ at their ends.
std::string cut_name(const std::string& name, float width);
/// The text in lines of at most `room` pixels in the current font, broken at spaces alone:
/// no number is split.
std::string in_lines(const std::string& text, float room);
/// Text in such lines; width 0: what is left.
void paragraph(const std::string& text, float width = 0);
/// Small grey text, in lines.
void hint(Ui& ui, const std::string& text);

struct ProgressOptions {
  float fraction = -1;  ///< 0..1; negative: not known, the bar moves
  std::string left;     ///< on its left: what is being done
  std::string right;    ///< on its right: "12 s left"
  bool cancellable = true;
};
/// True when cancel was clicked (marked NAME.cancel).
bool progress(Ui& ui, const std::string& name, const ProgressOptions& options);

/// An upright line that is dragged to change the size of the area on its right, within limits; pixels at
/// scale 1.
void splitter(Ui& ui, const std::string& name, float& size, float min, float max);

}  // namespace understudy::ui
