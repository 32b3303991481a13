#include "ui/panels/metrics.hpp"

#include <algorithm>
#include <cctype>

#include "app/run/flat_figures.hpp"
#include "app/session/frame_figures.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/metrics/metric_table.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"
#include "ui/panels/timeline.hpp"
#include "ui/widgets/lists.hpp"
#include "ui/widgets/plot.hpp"

namespace understudy::ui {
namespace {

/// The same figure of all takes, the selected one first.
std::vector<PlotLine> overlaid(const app::Session& session, const app::Series& of_selected) {
  std::vector<PlotLine> all;
  const auto add = [&](size_t take, const app::Series& series) {
    const bool named = take < session.document.takes.size();
    all.push_back(
        {named ? session.document.takes[take].name : "", series.values, static_cast<int>(take % 8)});
  };
  const size_t selected = session.selected_take;
  add(selected, of_selected);
  for (size_t k = 0; k < session.takes.size(); ++k)
    if (const app::Series* same =
            k == selected ? nullptr : app::find(session.takes[k].series, of_selected.key))
      add(k, *same);
  return all;
}

/// "PA-MPJPE, m" for "pa_mpjpe_m"; a metric of a newer version as plain words.
std::string words_of(const std::string& key) {
  if (const Metric* const known = find_metric(key))
    return *known->unit == 0 ? known->label : std::string(known->label) + ", " + known->unit;
  if (const app::FlatFigure* const flat = app::find_flat_figure(key))
    return std::string(flat->label) + ", " + flat->unit;
  std::string words = key;
  std::replace(words.begin(), words.end(), '_', ' ');
  if (!words.empty()) words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

/// For people who do not know it.
std::string hint_of(const std::string& key) {
  const Metric* const known = find_metric(key);
  if (known == nullptr) return app::find_flat_figure(key) ? "The lower, the better." : "";
  std::string words = known->better == Better::Lower    ? "The lower, the better."
                      : known->better == Better::Higher ? "The higher, the better."
                                                        : "";
  if ((known->needs & kNeedsTruth) != 0)
    words += words.empty() ? "Needs ground truth." : " Needs ground truth.";
  return words;
}

void draw_curve_of(const app::Session& session, PanelContext& context, const TimelineState& timeline,
                   const app::Series& series) {
  Ui& ui = context.ui;
  const bool in_timeline = session.view.metric == series.key;
  const float side = ImGui::GetFrameHeight();
  const FontScope strong(ui.fonts().strong);
  ImGui::AlignTextToFramePadding();
  text_cut(ui, series.label, ImGui::GetContentRegionAvail().x - side - ui.px(8));
  if (const std::string words = hint_of(series.key); !words.empty()) tooltip(ui, series.label + ". " + words);
  ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - side);
  const FontScope body(ui.fonts().body);
  if (icon_button(ui, "metrics.in_timeline." + series.key, Icon::Chart,
                  {in_timeline ? "In the timeline" : "Show it in the timeline", "", in_timeline, false, 26}))
    context.ask("view.metric", {series.key});
  PlotOptions options;
  options.unit = series.unit, options.height = 128;
  options.current = app::shown_frame(session);
  options.bad_frames = timeline.bad_numbers;
  if (const auto frame = plot(ui, "metrics.plot." + series.key, overlaid(session, series), options))
    context.ask("playback.frame", {std::to_string(*frame)});
}

/// The keys of all takes' figures, in the order of first appearance.
std::vector<std::string> figure_keys(const app::Session& session) {
  std::vector<std::string> keys;
  for (const app::TakeState& take : session.takes)
    for (const auto& [key, value] : take.metrics)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  return keys;
}

std::string figure_of(const app::Metrics& metrics, const std::string& key) {
  const Metric* const known = find_metric(key);
  for (const auto& [name, value] : metrics)
    if (name == key) return known ? printed("%.*f", known->digits, value) : figure(value, "");
  return "\u2013";
}

/// What is left out while there is no ground truth; those of bodies in space say nothing of 2D poses.
void draw_needing_truth(const app::Session& session, Ui& ui) {
  const size_t take = session.selected_take;
  const bool is_flat = take < session.takes.size() && session.takes[take].flat;
  if (session.truth != nullptr || is_flat) return;
  std::string names;
  for (const Metric& metric : metric_table())
    if ((metric.needs & kNeedsTruth) != 0) names += (names.empty() ? "" : ", ") + std::string(metric.label);
  hint(ui, "Needs ground truth, which a case folder has: " + names + ".");
  ui.mark("metrics.needs_truth");
}

/// Of a column beside its text, at scale 1.
float padding(const Ui& ui) {
  return (2 * ImGui::GetStyle().CellPadding.x + 1) / ui.scale();
}

/// What the names of the metrics leave, at scale 1.
float room_for_takes(const Ui& ui) {
  constexpr float kNames = 120;
  return ImGui::GetContentRegionAvail().x / ui.scale() - kNames - padding(ui);
}

/// The current one and as many of the others, in their order, as the panel has room for.
std::vector<size_t> takes_that_fit(const app::Session& session, const Ui& ui) {
  constexpr float kLeast = 48;
  const size_t count = std::min(session.takes.size(), session.document.takes.size()),
               selected = session.selected_take;
  const size_t fit = std::clamp<size_t>(std::max(1.0f, room_for_takes(ui) / (kLeast + padding(ui))), 1,
                                        std::max<size_t>(count, 1));
  std::vector<size_t> takes;
  for (size_t k = 0; k < count; ++k)
    if (k == selected || takes.size() + (selected > k ? 1 : 0) < fit) takes.push_back(k);
  return takes;
}

void draw_figures(const app::Session& session, Ui& ui) {
  const std::vector<std::string> keys = figure_keys(session);
  if (keys.empty()) {
    hint(ui, session.working ? "Shown when all frames are processed." : "Nothing to compare yet.");
    return;
  }
  const std::vector<size_t> takes = takes_that_fit(session, ui);
  constexpr float kUsual = 72;
  const float width = std::min(kUsual, (room_for_takes(ui) - padding(ui) * takes.size()) / takes.size());
  std::vector<Column> columns = {{"Metric", 0, false}};
  for (const size_t k : takes) columns.push_back({session.document.takes[k].name, width, true});
  if (Table table(ui, "metrics.figures", columns); table.open())
    for (const std::string& key : keys) {
      table.row(false, false);
      table.whole_cell(words_of(key));
      if (const std::string words = hint_of(key); !words.empty()) tooltip(ui, words);
      for (const size_t k : takes) table.cell(figure_of(session.takes[k].metrics, key));
    }
  if (takes.size() < session.document.takes.size()) hint(ui, "A wider panel shows more takes.");
}

void draw_stages(const app::Latency& latency, Ui& ui) {
  Table table(ui, "metrics.stages", {{"Stage", 0, false}, {"p50, ms", 72, true}, {"p95, ms", 72, true}});
  if (!table.open()) return;
  for (int stage = 0; stage < ssize(app::Latency::kStages); ++stage) {
    table.row(false, false);
    table.cell(app::Latency::kStages[stage]);
    table.cell(latency.quantile(stage, 0.5));
    table.cell(latency.quantile(stage, 0.95));
  }
}

/// Durations that are distributed as those measured, without the few extremes that would squeeze the rest.
void follow_latency(const app::Latency& latency, int take, MetricsState& state) {
  if (state.frames == latency.frames() && state.of_stage == state.stage && state.of_take == take) return;
  state.frames = latency.frames(), state.of_stage = state.stage, state.of_take = take;
  constexpr int kCount = 256;
  state.durations.resize(kCount);
  for (int i = 0; i < kCount; ++i)
    state.durations[i] = static_cast<float>(latency.quantile(state.stage, 0.99 * (i + 0.5) / kCount));
}

void draw_latency(const app::Session& session, PanelContext& context, MetricsState& state) {
  Ui& ui = context.ui;
  const app::TakeState* take = selected_state(session);
  if (take == nullptr || take->latency.frames() == 0) {
    hint(ui, "Nothing measured yet.");
    return;
  }
  draw_stages(take->latency, ui);
  std::vector<std::string> stages(app::Latency::kStages.begin(), app::Latency::kStages.end());
  row(ui, "Histogram of", "How the time per frame is distributed, without the slowest 1 %");
  dropdown(ui, "metrics.stage", stages, state.stage);
  follow_latency(take->latency, session.selected_take, state);
  HistogramOptions options;
  options.unit = "ms";
  options.marks = {{"p50", static_cast<float>(take->latency.quantile(state.stage, 0.5))},
                   {"p95", static_cast<float>(take->latency.quantile(state.stage, 0.95))}};
  histogram(ui, "metrics.histogram", state.durations, options);
}

}  // namespace

void draw_metrics(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  auto& timeline = panel_state<TimelineState>(context);
  timeline.follow(session);
  const app::TakeState* take = selected_state(session);
  if (section(ui, "metrics.curves", "Over time")) {
    const bool any = take != nullptr && !take->series.empty();
    if (!any) hint(ui, "Metrics appear as frames are processed.");
    if (any)
      for (const app::Series& series : take->series) draw_curve_of(session, context, timeline, series);
    ask_button(context,
               {"metrics.csv", "Export CSV\u2026",
                "Exports every metric of every frame as a table for other programs", "dialog.open csv"},
               any);
  }
  if (section(ui, "metrics.table", "Whole sequence")) {
    draw_figures(session, ui);
    draw_needing_truth(session, ui);
  }
  if (section(ui, "metrics.latency", "Latency"))
    draw_latency(session, context, panel_state<MetricsState>(context));
}

}  // namespace understudy::ui
