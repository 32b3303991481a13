// The log: the program's messages, newest last.
// Marks: log.warnings (filter), log.copy, log.clear, log.close, log.lines.
#include "ui/panels/panels.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

struct LogState {
  bool warnings_only = false;
  size_t seen = 0;  ///< lines drawn last, to stay at the end as it grows
};

std::vector<const app::LogLine*> shown_lines(const app::Session& session, const LogState& state) {
  std::vector<const app::LogLine*> lines;
  for (const app::LogLine& line : session.log)
    if (line.warning || !state.warnings_only) lines.push_back(&line);
  return lines;
}

void draw_head(const app::Session& session, PanelContext& context, LogState& state) {
  Ui& ui = context.ui;
  {
    const FontScope strong(ui.fonts().strong);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Log");
  }
  ImGui::SameLine(0, ui.px(16));
  toggle(ui, "log.warnings", "Warnings only", state.warnings_only);
  ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - ui.px(3 * 31 - 3));
  if (icon_button(ui, "log.copy", Icon::Copy, {"Copy all lines", "", false, session.log.empty(), 28})) {
    std::string all;
    for (const app::LogLine* line : shown_lines(session, state)) all += line->text + "\n";
    ImGui::SetClipboardText(all.c_str());
  }
  ImGui::SameLine(0, ui.px(3));
  if (icon_button(ui, "log.clear", Icon::Trash, {"Clear the log", "", false, session.log.empty(), 28}))
    context.ask("log.clear");
  ImGui::SameLine(0, ui.px(3));
  if (icon_button(ui, "log.close", Icon::Close, {"Hide the log", "", false, false, 28}))
    context.ask("panel.show", {"log", "off"});
}

}  // namespace

void draw_log(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  auto& state = panel_state<LogState>(context);
  draw_head(session, context, state);
  const auto lines = shown_lines(session, state);
  const bool grew = lines.size() != state.seen;
  state.seen = lines.size();
  if (ImGui::BeginChild("##lines")) {
    const bool at_end = ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1;
    ImGuiListClipper clipper;
    clipper.Begin(lines.size());
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const app::LogLine& line = *lines[i];
        const ColorScope words(ImGuiCol_Text, line.warning ? ui.theme().warning : ui.theme().text);
        text_cut(ui, line.text);
      }
    if (lines.empty()) hint(ui, state.warnings_only ? "No warnings." : "Nothing yet.");
    if (grew && at_end) ImGui::SetScrollHereY(1);
  }
  ImGui::EndChild();
}

}  // namespace understudy::ui
