#include "ui/panels/rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

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

}  // namespace

std::optional<bool> toggle_row(Ui& ui, const RowText& text, bool on) {
  row(ui, text.label, text.explanation);
  return toggle(ui, text.name, "", on) ? std::optional<bool>(on) : std::nullopt;
}

std::optional<int> choice_row(Ui& ui, const RowText& text, const std::vector<std::string>& choices,
                              int chosen) {
  row(ui, text.label, text.explanation);
  const bool fits = choices.size() <= 4 && words_width(ui, choices) <= ImGui::GetContentRegionAvail().x;
  const bool changed =
      fits ? segmented(ui, text.name, choices, chosen) : dropdown(ui, text.name, choices, chosen);
  return changed ? std::optional<int>(chosen) : std::nullopt;
}

std::optional<std::string> method_row(Ui& ui, const RowText& text, const MethodChoices& choices,
                                      const std::string& chosen) {
  const auto i = choice_row(ui, text, labels_of(choices), index_of(choices, chosen));
  if (!i) return std::nullopt;
  return choices[static_cast<size_t>(*i)].name;
}

std::optional<float> number_row(Ui& ui, const RowText& text, float value, const NumberOptions& options) {
  row(ui, text.label, text.explanation);
  return number(ui, text.name, value, options) ? std::optional<float>(value) : std::nullopt;
}

std::optional<std::string> text_row(Ui& ui, const RowText& text, const std::string& value,
                                    const std::string& hint) {
  row(ui, text.label, text.explanation);
  return committed_text(ui, text.name, value, hint);
}

std::optional<double> typed_number_row(Ui& ui, const RowText& text, double value, int decimals) {
  char words[64];
  std::snprintf(words, sizeof words, "%.*f", decimals, value);
  const std::optional<std::string> typed = text_row(ui, text, words);
  return typed ? parse_number(*typed) : std::nullopt;
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

ButtonRow::ButtonRow(int count) : left_(count) {}

bool ButtonRow::add(Ui& ui, const std::string& name, const std::string& label, ButtonOptions options) {
  const float gap = ImGui::GetStyle().ItemSpacing.x, count = static_cast<float>(left_);
  options.width = std::max(1.f, std::floor((ImGui::GetContentRegionAvail().x - gap * (count - 1)) / count));
  const bool clicked = button(ui, name, label, options);
  if (--left_ > 0) ImGui::SameLine();
  return clicked;
}

}  // namespace understudy::ui
