// Rows and buttons of panels: they change a value of their caller, or ask for a command.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "retarget/pipeline/method_table.hpp"
#include "ui/panels/panel.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {

struct Control {
  std::string name;                    ///< id and mark
  std::string label = {};              ///< of a row: grey, on the left
  std::string explanation = {};        ///< when the pointer rests on the label, a switch or a number
  std::string command = {};            ///< as a line of a script: "edit.pin 0"; empty: the name
  std::vector<std::string> tips = {};  ///< of choices, what each means
};

/// What each RootMode means, for the choices of "Path".
std::vector<std::string> path_tips();

/// Pushes its command, with the user's new value as its last argument where there is one.
void push(PanelContext& context, const Control& control, const std::string& value = {});

// Rows whose value the caller keeps. True when the user changed it.

bool toggle_row(Ui& ui, const Control& control, bool& on);
/// A few choices beside each other, or a list where there are many.
bool choice_row(Ui& ui, const Control& control, const std::vector<std::string>& choices, int& chosen);
/// The name of an engine or extractor; a name that is in no row leaves nothing chosen.
bool method_row(Ui& ui, const Control& control, const MethodChoices& choices, std::string& chosen);
/// Changes on Enter or when the field loses focus: for values that cost work. Nothing while the value stays.
std::optional<std::string> text_row(Ui& ui, const Control& control, const std::string& value,
                                    const std::string& hint = {});
/// A folder to type or to choose. True when the user wants to choose it. Marks: NAME, NAME.browse.
bool folder_row(Ui& ui, const Control& control, const std::string& hint, std::string& folder);
/// As text_row; ignores text that is not a number.
std::optional<double> typed_number_row(Ui& ui, const Control& control, double value, int decimals = 2);

// Controls that push their command; rows with the user's new value as its last argument.

void ask_toggle(PanelContext& context, const Control& control, bool on);
/// As choice_row; `words` are what the choices are called in the command, `chosen` one of them.
void ask_choice(PanelContext& context, const Control& control, const std::vector<std::string>& choices,
                const std::vector<std::string>& words, const std::string& chosen);
/// As method_row.
void ask_method(PanelContext& context, const Control& control, const MethodChoices& choices,
                const std::string& chosen);
/// Changes with every movement of the mouse: for values that take effect at once.
void ask_number(PanelContext& context, const Control& control, float value, const NumberOptions& options);
/// Over the whole width.
void ask_button(PanelContext& context, const Control& control, bool enabled = true);

/// How far a background job is, the time that it takes yet, and a cancel that asks for it. fraction: 0..1;
/// below 0 it is not known. Marks: NAME, NAME.cancel.
void job_progress(const app::Session& session, PanelContext& context, const std::string& name, int64_t job,
                  float fraction, const std::string& words);

/// A button that takes a tool, lit while it is taken. Without a label: called what the tool is.
void tool_button(const app::Session& session, PanelContext& context, const Control& control, app::Tool tool);

/// What the brush of the painting tool is like. Marks: PREFIX.brush_radius, .brush_strength, .brush_mode.
void brush_rows(const app::Session& session, PanelContext& context, const std::string& prefix);

/// A sentence with a warning sign before it.
void warning_sentence(Ui& ui, const std::string& sentence);
/// A small square of a colour, before what follows on the line.
void color_chip(Ui& ui, const ImVec4& of);

/// The field alone, over the width that is left.
std::optional<std::string> committed_text(Ui& ui, const std::string& name, const std::string& value,
                                          const std::string& hint = {});
/// The number at the beginning of the text, units may follow; none without one.
std::optional<double> parse_number(const std::string& text);

/// Buttons beside each other, each over its share of the width.
struct ButtonRow {
  explicit ButtonRow(int count) : left_(count) {}
  bool add(Ui& ui, const std::string& name, const std::string& label, ButtonOptions options = {});
  /// Pushes its command.
  void ask(PanelContext& context, const Control& control, bool enabled = true);

 private:
  int left_;
};

}  // namespace understudy::ui
