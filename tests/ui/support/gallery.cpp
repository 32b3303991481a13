#include "tests/ui/support/gallery.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ui/widgets/controls.hpp"
#include "ui/widgets/lists.hpp"
#include "ui/widgets/plot.hpp"
#include "ui/widgets/timeline_track.hpp"

namespace understudy::ui {
namespace {

std::vector<float> wave(int count, float base, float swing, float speed) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) {
    const auto t = static_cast<float>(i);
    values.push_back(base + swing * std::sin(speed * t) * std::cos(0.31f * speed * t) +
                     0.2f * swing * std::sin(7.3f * t));
  }
  return values;
}

void draw_toolbar(Ui& ui) {
  IconButtonOptions tip;
  tip.tooltip = "Undo: rotate left elbow", tip.shortcut = "Ctrl+Z";
  icon_button(ui, "edit.undo", Icon::Undo, tip);
  for (int i = static_cast<int>(Icon::Redo); i < static_cast<int>(Icon::Count); ++i) {
    ImGui::SameLine(0, ui.px(2));
    if (ImGui::GetContentRegionAvail().x < ui.px(30)) ImGui::NewLine();
    IconButtonOptions options;
    options.tooltip = std::string(icon_name(static_cast<Icon>(i)));
    options.active = i == static_cast<int>(Icon::Brush), options.disabled = i == static_cast<int>(Icon::Redo);
    icon_button(ui, "icon." + options.tooltip, static_cast<Icon>(i), options);
  }
}

void draw_controls(Ui& ui, GalleryState& state) {
  if (section(ui, "gallery.source", "Source")) {
    row_text(ui, "Files", "1,204 frames, PLY, 9,830 points each");
    row_text(ui, "Rate", "30 frames/s");
    row(ui, "View", "How the source is drawn");
    segmented(ui, "gallery.view", {"Points", "Mesh", "Off"}, state.view);
    row(ui, "Method");
    dropdown(ui, "gallery.method", {"Full method", "Without offsets", "Skeleton only"}, state.method);
    row(ui, "Smoothing");
    NumberOptions smoothing;
    smoothing.min = 0, smoothing.max = 1, smoothing.resettable = true, smoothing.initial = 0.2f;
    number(ui, "gallery.smoothing", state.smoothing, smoothing);
    row(ui, "Brush radius");
    NumberOptions radius;
    radius.format = "%.0f mm", radius.min = 1, radius.max = 100;
    number(ui, "gallery.radius", state.radius, radius);
    row(ui, "Name");
    text_field(ui, "gallery.name", state.name, "Name of the clip");
    row(ui, "Layers");
    toggle(ui, "gallery.skeleton", "Skeleton", state.skeleton);
    row(ui, "");
    toggle(ui, "gallery.weights", "Skin weights", state.weights);
  }
  section(ui, "gallery.closed", "Target", false);
  ImGui::Dummy({0, ui.px(2)});
  button(ui, "gallery.open", "Open scan\u2026", {ButtonLook::Main, "Opens a scan", "Ctrl+O"});
  ImGui::SameLine();
  button(ui, "gallery.export", "Export");
  ImGui::SameLine();
  button(ui, "gallery.delete", "Delete", {ButtonLook::Danger, "Removes the clip", ""});
  ImGui::SameLine();
  button(ui, "gallery.more", "More", {ButtonLook::Quiet, "Other things", ""});
  ProgressOptions progress_options;
  progress_options.fraction = 0.62f, progress_options.left = "Retargeting walk_female_03",
  progress_options.right = "12 s left";
  progress(ui, "gallery.job", progress_options);
  hint(ui,
       "Hips and feet are pinned to the floor while both soles are lower than 5 cm; the rest is redone from "
       "there.");
}

void draw_plots(Ui& ui, GalleryState& state) {
  std::vector<float> full = wave(1204, 31, 9, 0.02f), without = wave(1204, 44, 12, 0.017f);
  for (int i = 500; i < 560; ++i) full[static_cast<size_t>(i)] = std::numeric_limits<float>::quiet_NaN();
  PlotOptions options;
  options.unit = "mm", options.current = state.frame, options.bad_frames = {120, 121, 500, 530, 559, 900};
  if (const auto frame =
          plot(ui, "gallery.mpjpe", {{"Full method", full}, {"Without offsets", without}}, options))
    state.frame = *frame;
  std::vector<float> few = wave(40, 0.004f, 0.01f, 0.4f);
  few[20] = few[22] = std::numeric_limits<float>::quiet_NaN();
  PlotOptions small;
  small.unit = "m/frame\u00b2", small.height = 110;
  plot(ui, "gallery.acc", {{"Acc", few, 2}}, small);
  HistogramOptions latency;
  latency.unit = "ms", latency.marks = {{"p50", 31.f}, {"p95", 40.f}};
  histogram(ui, "gallery.latency", full, latency);
}

void draw_lists(Ui& ui) {
  searchable_list(ui, "gallery.list",
                  {{"pelvis", "root"},
                   {"left_hip", "3 frames"},
                   {"right_hip", ""},
                   {"spine1", ""},
                   {"left_knee", "12 frames"}},
                  1, ui.px(140));
  Table rows(ui, "gallery.table", {{"Metric", 0, false}, {"Full", 64, true}, {"Without", 64, true}});
  if (!rows.open()) return;

  const struct {
    const char* name;
    double a, b;
  } metrics[] = {
      {"MPJPE", 31.2, 44.9}, {"PA-MPJPE", 22.8, 35.1}, {"Acc", 4.1, std::nan("")}, {"MEDL", 2.25, 3.5}};
  for (const auto& metric : metrics) {
    rows.row(metric.a == 22.8);
    rows.cell(metric.name), rows.cell(metric.a), rows.cell(metric.b);
  }
}

void draw_column(Ui& ui, const char* name, float width, float height, const std::function<void()>& content) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(12), ui.px(10)});
  const ColorScope panel(ImGuiCol_ChildBg, ui.theme().panel);
  ImGui::BeginChild(name, {width, height}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
  content();
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

}  // namespace

void draw_gallery(Ui& ui, GalleryState& state) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  const ColorScope backdrop(ImGuiCol_WindowBg, ui.theme().backdrop);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("gallery", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBringToFrontOnFocus);
  {
    const FontScope title(ui.fonts().title);
    ImGui::TextUnformatted("Understudy");
  }
  draw_toolbar(ui);
  const float below = ui.px(124), height = ImGui::GetContentRegionAvail().y - below;
  const float third = (ImGui::GetContentRegionAvail().x - 2 * ui.px(8)) / 3;
  draw_column(ui, "left", third, height, [&] { draw_controls(ui, state); });
  ImGui::SameLine();
  draw_column(ui, "middle", third, height, [&] { draw_plots(ui, state); });
  ImGui::SameLine();
  draw_column(ui, "right", 0, height, [&] { draw_lists(ui); });
  const std::vector<float> curve = wave(1204, 31, 9, 0.02f);
  draw_column(ui, "below", 0, 0, [&] {
    TrackData track;
    track.total = 1204, track.processed = 960, track.current = state.frame, track.loop = LoopRange{200, 700};
    track.bad_frames = {120, 121, 122, 530, 531, 900}, track.curve = curve, track.curve_label = "MPJPE, mm";
    if (const auto answer = timeline_track(ui, "gallery.track", track); answer.seek)
      state.frame = *answer.seek;
  });
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace understudy::ui
