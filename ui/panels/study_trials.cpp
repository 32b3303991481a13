// The trials of a study: all of them, or those of a participant in their order, and the chosen one.
#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"
#include "ui/panels/study.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

using app::StudyList;
using app::Trial;

constexpr int kMostRows = 1000;

/// What a trial shows of the factor that is studied: "Copy", or "Copy, Paper".
std::string conditions_of(const app::Study& study, const Trial& trial) {
  std::string names = study.conditions[static_cast<size_t>(trial.condition)].name;
  if (trial.other >= 0) append_item(names, study.conditions[static_cast<size_t>(trial.other)].name);
  return names;
}

void draw_table(const app::StudyState& state, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Study& study = *state.study;
  const int count = static_cast<int>(std::min<std::ptrdiff_t>(ssize(state.trials), kMostRows));
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = line * (static_cast<float>(std::min(count, 8)) + 1.5f);
  const bool motions = study.motions.size() > 1, targets = study.targets.size() > 1;  // else all are alike
  std::vector<Column> columns = {{"Trial", 42}, {"Condition"}};
  if (motions) columns.push_back({"Motion"});
  if (targets) columns.push_back({"Target"});
  if (Table table(ui, "study.trial", columns, height); table.open())
    for (int i = 0; i < count; ++i) {
      const Trial& trial = state.trials[static_cast<size_t>(i)];
      const bool is_chosen = i == app::chosen(state, StudyList::Trial);
      if (table.row(is_chosen)) context.ask("study.choose", {"trial", std::to_string(i)});
      table.cell(trial.id);
      table.cell(conditions_of(study, trial));
      if (motions) table.cell(study.motions[static_cast<size_t>(trial.motion)].name);
      if (targets) table.cell(study.targets[static_cast<size_t>(trial.target)].name);
    }
  if (ssize(state.trials) > count)
    hint(ui, "The first " + grouped(count) + " of " + grouped(ssize(state.trials)) + " trials.");
}

/// Which moment of clips the picture shows.
struct Moment {
  float percent = 10;
};

/// The chosen trial as participants see it.
void draw_picture(const app::StudyState& state, PanelContext& context) {
  if (!context.trial_picture || app::chosen(state, StudyList::Trial) < 0) return;
  Ui& ui = context.ui;
  auto& moment = panel_state<Moment>(context).percent;
  const TrialPicture picture = context.trial_picture(std::round(moment) / 100);
  const app::StudyPicture& shape = state.study->picture;
  const float width = std::floor(ImGui::GetContentRegionAvail().x);
  const float height = std::round(
      std::min(width * static_cast<float>(shape.height) / static_cast<float>(shape.width), 1.5f * width));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Rect place{at, {at.x + width, at.y + height}};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(place.min, place.max, color(ui.theme().backdrop), ui.px(4));
  if (picture.texture != nullptr) {
    const float across = std::min(width, height * picture.width / picture.height),
                left = (width - across) / 2;
    list.AddImageRounded(picture.texture, {at.x + left, at.y}, {at.x + left + across, place.max.y}, {0, 0},
                         {1, 1}, IM_COL32_WHITE, ui.px(4));
  } else {
    const std::string words = in_lines(picture.text, width - ui.px(24));
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    list.AddText({std::floor(at.x + (width - size.x) / 2), std::floor(at.y + (height - size.y) / 2)},
                 color(ui.theme().text_dim), words.c_str());
  }
  ImGui::Dummy({width, height});
  ui.mark(picture.texture != nullptr ? "study.picture" : "study.no_picture");
  row(ui, "Moment", "Of the clip that the picture shows");
  number(ui, "study.moment", moment, {0, 100, 0.5f, "%.0f %%"});
}

void draw_chosen(const app::StudyState& state, PanelContext& context) {
  const int i = app::chosen(state, StudyList::Trial);
  if (i < 0) return;
  Ui& ui = context.ui;
  const app::Study& study = *state.study;
  const Trial& trial = state.trials[static_cast<size_t>(i)];
  row_text(ui, "Shows", conditions_of(study, trial));
  row_text(ui, "Motion", study.motions[static_cast<size_t>(trial.motion)].name);
  row_text(ui, "Target", study.targets[static_cast<size_t>(trial.target)].name);
  std::string questions;
  for (const int q : trial.questions) append_item(questions, study.questions[static_cast<size_t>(q)].name);
  row_text(ui, "Asks", questions);
  if (trial.is_practice) hint(ui, "A trial of practice: its answers do not count.");
}

}  // namespace

void draw_study_trials(const app::Session& session, PanelContext& context) {
  const app::StudyState& state = session.study;
  const std::string count = state.problem.empty() ? " (" + grouped(ssize(state.trials)) + ")" : "";
  if (!section(context.ui, "study.trials", "Trials" + count)) return;
  const auto name =
      text_row(context.ui, {"study.participant", "Participant", "In whose order the trials are listed"},
               state.participant, "all, as designed");
  if (name && name->empty()) context.ask("study.participant");
  if (name && !name->empty()) context.ask("study.participant", {*name});
  if (!state.problem.empty()) return hint(context.ui, "The list comes when the study can be run.");
  draw_table(state, context);
  draw_picture(state, context);
  draw_chosen(state, context);
}

}  // namespace understudy::ui
