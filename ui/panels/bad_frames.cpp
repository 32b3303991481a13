// The frames that are not to be trusted, with the reason: one line for each run of frames with the same one.
// Marks: bad_frames.close, bad_frames.list.search, bad_frames.list.K (the K-th run; a click shows its first
// frame).
#include "ui/panels/panels.hpp"
#include "ui/panels/timeline.hpp"
#include "ui/widgets/controls.hpp"
#include "ui/widgets/lists.hpp"

namespace understudy::ui {
namespace {

struct Run {
  int first, last;
  std::string why;
};

std::vector<Run> runs_of(const std::vector<app::BadFrame>& frames) {
  std::vector<Run> runs;
  for (const app::BadFrame& bad : frames) {
    const bool goes_on = !runs.empty() && runs.back().last + 1 == bad.frame && runs.back().why == bad.why;
    if (goes_on)
      runs.back().last = bad.frame;
    else
      runs.push_back({bad.frame, bad.frame, bad.why});
  }
  return runs;
}

std::string frames_of(const Run& run) {
  const std::string first = std::to_string(run.first);
  return run.first == run.last ? "frame " + first : "frames " + first + "\u2013" + std::to_string(run.last);
}

void draw_head(PanelContext& context, size_t bad) {
  Ui& ui = context.ui;
  {
    const FontScope strong(ui.fonts().strong);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Bad frames");
  }
  ImGui::SameLine(0, ui.px(16));
  ImGui::TextUnformatted(std::to_string(bad).c_str());
  ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - ui.px(28));
  if (icon_button(ui, "bad_frames.close", Icon::Close, {"Hide the bad frames", "", false, false, 28}))
    context.ask("panel.show", {"bad_frames", "off"});
}

}  // namespace

void draw_bad_frames(const app::Session& session, PanelContext& context) {
  auto& timeline = panel_state<TimelineState>(context);
  timeline.follow(session);
  draw_head(context, timeline.bad.size());
  if (timeline.bad.empty()) return hint(context.ui, "No bad frames so far.");
  const std::vector<Run> runs = runs_of(timeline.bad);
  std::vector<ListItem> items;
  int shown = -1;
  for (const Run& run : runs) {
    const int frame = app::shown_frame(session);
    if (run.first <= frame && frame <= run.last) shown = items.size();
    items.push_back({run.why, frames_of(run)});
  }
  const int chosen = searchable_list(context.ui, "bad_frames.list", items, shown);
  if (chosen >= 0) context.ask("playback.frame", {std::to_string(runs[chosen].first)});
}

}  // namespace understudy::ui
