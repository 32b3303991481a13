// Rows of panels: they show the session's value and return the user's new one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "retarget/pipeline/method_table.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {

// All return the user's choice, nothing while the value stays.

struct RowText {
  std::string name;         ///< id and mark
  std::string label;        ///< grey, on the left
  std::string explanation;  ///< when the pointer rests on the label
};

std::optional<bool> toggle_row(Ui& ui, const RowText& text, bool on);
/// A few choices beside each other, or a list where there are many.
std::optional<int> choice_row(Ui& ui, const RowText& text, const std::vector<std::string>& choices,
                              int chosen);
/// The name of an engine or extractor; a name that is in no row leaves nothing chosen.
std::optional<std::string> method_row(Ui& ui, const RowText& text, const MethodChoices& choices,
                                      const std::string& chosen);
/// Changes with every movement of the mouse: for values that take effect at once.
std::optional<float> number_row(Ui& ui, const RowText& text, float value, const NumberOptions& options);
/// Changes on Enter or when the field loses focus: for values that cost work.
std::optional<std::string> text_row(Ui& ui, const RowText& text, const std::string& value,
                                    const std::string& hint = {});
/// As text_row; ignores text that is not a number.
std::optional<double> typed_number_row(Ui& ui, const RowText& text, double value, int decimals = 2);

/// The field alone, over the width that is left.
std::optional<std::string> committed_text(Ui& ui, const std::string& name, const std::string& value,
                                          const std::string& hint = {});
/// The number at the beginning of the text, units may follow; none without one.
std::optional<double> parse_number(const std::string& text);

/// A button over a share of the width that is left, for several beside each other: `share` of 1 / count.
struct ButtonRow {
  explicit ButtonRow(int count);
  bool add(Ui& ui, const std::string& name, const std::string& label, ButtonOptions options = {});

 private:
  int left_;
};

}  // namespace understudy::ui
