#include "ui/panels/rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "retarget/base/text.hpp"
#include "ui/panels/bindings.hpp"

namespace understudy::ui {
namespace {

struct Editing {
  bool active = false;
  std::string text;
};

/// The width that the words of all choices need beside each other.
float words_width(Ui& ui, const std::vector<std::string>& choices) {
  float widest = 0;
  for (const std::string& choice : choices) widest = std::max(widest, ImGui::CalcTextSize(choice.c_str()).x);
  return (widest + ui.px(10)) * static_cast<float>(choices.size());
}

/// With a sentence for each choice: "Copy: turns the target's bones as the source's turn."
Control explained(Control control, const MethodChoices& choices) {
  for (const MethodChoice& choice : choices) control.tips.push_back(tip_of(choice));
  return control;
}

ButtonOptions options_of(const Control& control, bool enabled) {
  ButtonOptions options;
  options.tooltip = control.explanation, options.disabled = !enabled, options.width = -1;
  return options;
}

}  // namespace

std::vector<std::string> path_tips() {
  return {"The source's metres times the ratio of the leg lengths, so that steps fit the legs.",
          "The source's own metres: feet may slide where the legs are of another length.",
          "No path: the target stays in one place."};
}

void push(PanelContext& context, const Control& control, const std::string& value) {
  app::Arguments words = app::split_line(control.command.empty() ? control.name : control.command);
  if (!value.empty()) words.push_back(value);
  context.ask(words[0], {words.begin() + 1, words.end()});
}

bool toggle_row(Ui& ui, const Control& control, bool& on) {
  row(ui, control.label, control.explanation);
  const bool changed = toggle(ui, control.name, "", on);
  tooltip(ui, control.explanation);
  return changed;
}

bool choice_row(Ui& ui, const Control& control, const std::vector<std::string>& choices, int& chosen) {
  row(ui, control.label, control.explanation);
  const bool fits = choices.size() <= 4 && words_width(ui, choices) <= ImGui::GetContentRegionAvail().x;
  return (fits ? segmented : dropdown)(ui, control.name, choices, chosen, control.tips);
}

bool method_row(Ui& ui, const Control& control, const MethodChoices& choices, std::string& chosen) {
  int i = index_of(choices, chosen);
  const bool changed = choice_row(ui, explained(control, choices), labels_of(choices), i);
  if (changed) chosen = choices[i].name;
  return changed;
}

bool folder_row(Ui& ui, const Control& control, const std::string& hint, std::string& folder) {
  row(ui, control.label, control.explanation);
  const IdScope id(control.name);
  const float side = ImGui::GetFrameHeight();
  ImGui::BeginChild("##path", {std::max(1.f, ImGui::GetContentRegionAvail().x - side - ui.px(6)), side});
  text_field(ui, control.name, folder, hint);
  if (!folder.empty()) tooltip(ui, folder);
  ImGui::EndChild();
  ImGui::SameLine(0, ui.px(6));
  return icon_button(ui, control.name + ".browse", Icon::Folder,
                     {"Choose the folder", "", false, false, side / ui.scale()});
}

void warning_sentence(Ui& ui, const std::string& sentence) {
  icon_label(ui, Icon::Warning, ui.theme().warning);
  ImGui::SameLine();
  paragraph(sentence);
}

std::optional<std::string> text_row(Ui& ui, const Control& control, const std::string& value,
                                    const std::string& hint) {
  row(ui, control.label, control.explanation);
  return committed_text(ui, control.name, value, hint);
}

std::optional<double> typed_number_row(Ui& ui, const Control& control, double value, int decimals) {
  const std::optional<std::string> typed = text_row(ui, control, printed("%.*f", decimals, value));
  return typed ? parse_number(*typed) : std::nullopt;
}

void job_progress(const app::Session& session, PanelContext& context, const std::string& name, int64_t job,
                  float fraction, const std::string& words) {
  ProgressOptions options;
  options.fraction = fraction, options.left = words;
  for (const app::JobView& view : session.jobs)
    if (view.id == job) options.right = time_left(view.seconds_left), options.cancellable = view.cancellable;
  if (progress(context.ui, name, options)) context.ask("job.cancel", {std::to_string(job)});
}

void tool_button(const app::Session& session, PanelContext& context, const Control& control, app::Tool tool) {
  const std::string word = app::kToolNames[static_cast<size_t>(tool)];
  const std::string label =
      control.label.empty() ? app::kToolLabels[static_cast<size_t>(tool)] : control.label;
  const bool taken = session.tool == tool;
  ButtonOptions options;
  options.look = taken ? ButtonLook::Main : ButtonLook::Plain, options.width = -1;
  options.shortcut = keys_of(context.commands, "tool", {word});
  options.tooltip = taken                         ? "Back to looking around"
                    : control.explanation.empty() ? label
                                                  : control.explanation;
  options.disabled = !possible(session, "tool");
  if (button(context.ui, control.name, label, options)) context.ask("tool", {taken ? "look" : word});
}

void brush_rows(const app::Session& session, PanelContext& context, const std::string& prefix) {
  ask_number(context,
             {prefix + ".brush_radius", "Radius", "Radius of the brush on the surface", "tool.brush_radius"},
             session.brush.radius_m, {0.005f, 0.5f, 0.0005f, "%.3f m"});
  ask_number(
      context,
      {prefix + ".brush_strength", "Strength", "Strength of a stroke at its centre", "tool.brush_strength"},
      session.brush.strength, {0.01f, 1, 0.005f, "%.2f"});
  ask_choice(context, {prefix + ".brush_mode", "Brush", "What a stroke does", "tool.brush_mode"},
             {"Add", "Subtract", "Smooth"}, {kBrushModeNames.begin(), kBrushModeNames.end()},
             kBrushModeNames[static_cast<size_t>(session.brush.mode)]);
}

void color_chip(Ui& ui, const ImVec4& of) {
  const float side = ui.px(10), line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 corner(at.x + ui.px(2), at.y + 0.5f * (line - side));
  ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + side, corner.y + side}, color(of), ui.px(2));
  ImGui::Dummy({side + ui.px(2), line});
  ImGui::SameLine(0, ui.px(7));
}

std::optional<std::string> committed_text(Ui& ui, const std::string& name, const std::string& value,
                                          const std::string& hint) {
  auto& editing = ui.state<Editing>(ImGui::GetID((name + ".editing").c_str()));
  if (!editing.active) editing.text = value;
  text_field(ui, name, editing.text, hint);
  editing.active = ImGui::IsItemActive();
  const bool done = ImGui::IsItemDeactivatedAfterEdit() && editing.text != value;
  return done ? std::optional<std::string>(editing.text) : std::nullopt;
}

std::optional<double> parse_number(const std::string& text) {
  std::string plain = text;
  std::replace(plain.begin(), plain.end(), ',', '.');
  char* end = nullptr;
  const double value = std::strtod(plain.c_str(), &end);
  return end != plain.c_str() && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

void ask_toggle(PanelContext& context, const Control& control, bool on) {
  if (toggle_row(context.ui, control, on)) push(context, control, on_off(on));
}

void ask_choice(PanelContext& context, const Control& control, const std::vector<std::string>& choices,
                const std::vector<std::string>& words, const std::string& chosen) {
  const auto found = std::find(words.begin(), words.end(), chosen);
  int i = found == words.end() ? -1 : static_cast<int>(found - words.begin());
  if (choice_row(context.ui, control, choices, i)) push(context, control, words[i]);
}

void ask_method(PanelContext& context, const Control& control, const MethodChoices& choices,
                const std::string& chosen) {
  ask_choice(context, explained(control, choices), labels_of(choices), names_of(choices), chosen);
}

void ask_number(PanelContext& context, const Control& control, float value, const NumberOptions& options) {
  row(context.ui, control.label, control.explanation);
  const bool has_reset = options.resettable && value != options.initial;  // which explains itself
  if (number(context.ui, control.name, value, options)) push(context, control, argument(value));
  if (!has_reset) tooltip(context.ui, control.explanation);
}

void ask_button(PanelContext& context, const Control& control, bool enabled) {
  if (button(context.ui, control.name, control.label, options_of(control, enabled))) push(context, control);
}

void ButtonRow::ask(PanelContext& context, const Control& control, bool enabled) {
  if (add(context.ui, control.name, control.label, options_of(control, enabled))) push(context, control);
}

bool ButtonRow::add(Ui& ui, const std::string& name, const std::string& label, ButtonOptions options) {
  const float gap = ImGui::GetStyle().ItemSpacing.x, count = static_cast<float>(left_);
  options.width = std::max(1.f, std::floor((ImGui::GetContentRegionAvail().x - gap * (count - 1)) / count));
  const bool clicked = button(ui, name, label, options);
  if (--left_ > 0) ImGui::SameLine();
  return clicked;
}

}  // namespace understudy::ui
