#include "ui/panels/bars.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"
#include "ui/panels/help.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

constexpr const char* kSendingWords = "Sending";

std::string words_of(const app::JobView& job) {
  return job.doing.empty() ? job.name : job.name + ", " + job.doing;
}

void draw_job(const app::Session& session, PanelContext& context, float width) {
  Ui& ui = context.ui;
  const app::JobView& job = session.jobs.front();
  ImGui::BeginChild("##job", {width, ui.px(kStatusHeight - 6)});
  std::string words = words_of(job);
  if (session.jobs.size() > 1) words += " (+" + std::to_string(session.jobs.size() - 1) + ")";
  job_progress(session, context, "status.job", job.id, job.progress, words);
  ImGui::EndChild();
}

/// Scans that are completed: no frame is there before all of them are.
void draw_completing(const app::Session& session, PanelContext& context, float width) {
  Ui& ui = context.ui;
  ImGui::BeginChild("##completing", {width, ui.px(kStatusHeight - 6)});
  if (progress(ui, "status.completing", {session.source.completing, "Completing the scans", "", true}))
    context.ask("source.complete", {"off"});
  ImGui::EndChild();
}

/// What all jobs do, when there are several: each with its own cancel.
void draw_more_jobs(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  ImGui::SameLine();
  const float side = ui.px(24);
  ImGui::SetCursorPosY((ui.px(kStatusHeight) - side) / 2);
  if (icon_button(ui, "status.more_jobs", Icon::ChevronUp, {"All jobs", "", false, false, 24}))
    ImGui::OpenPopup("jobs");
  const ImVec2 above = ImGui::GetItemRectMin();
  ImGui::SetNextWindowPos({above.x, above.y - ui.px(4)}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({ui.px(320), 0});
  if (!ImGui::BeginPopup("jobs")) return;
  for (const app::JobView& job : session.jobs)
    job_progress(session, context, "status.job." + std::to_string(job.id), job.id, job.progress,
                 words_of(job));
  ImGui::EndPopup();
}

/// What the mouse does in the views with the current tool.
void draw_mouse_hint(const app::Session& session, Ui& ui, float width) {
  if (!has_document(session)) return;
  ImGui::SetCursorPosY((ui.px(kStatusHeight) - ImGui::GetTextLineHeight()) / 2);
  const ColorScope faint(ImGuiCol_Text, ui.theme().text_dim);
  const bool is_flat = app::is_canvas(session, session.view.active_pane);
  text_cut(ui, is_flat ? canvas_help(session.tool) : views_help(session.tool), width - ui.px(20));
  ui.mark("status.mouse");
}

/// The newest message, or what still has to be mended; else what the mouse does.
void draw_message(const app::Session& session, PanelContext& context, float width) {
  Ui& ui = context.ui;
  const std::optional<app::LogLine> line = app::status_line(session);
  if (width < ui.px(40)) return;
  if (!line) return draw_mouse_hint(session, ui, width);
  ImGui::SetCursorPosY((ui.px(kStatusHeight) - ImGui::GetFrameHeight()) / 2);
  const std::string words = cut_to(line->text, width - ui.px(20));
  ButtonOptions options;
  options.look = ButtonLook::Quiet, options.tooltip = line->text;
  const ColorScope color(ImGuiCol_Text, line->warning ? ui.theme().warning : ui.theme().text_dim);
  if (button(ui, "status.message", words, options))
    context.ask("panel.show", {"log", on_off(!panel_shown(session, "log"))});
}

std::string document_words(const app::Session& session) {
  if (!has_document(session)) return "";
  return (session.path.empty() ? "Not saved yet" : file_name(session.path)) + (session.changed ? " *" : "");
}

/// Nobody forgets that poses leave the program.
void draw_sending_sign(const app::Session& session, PanelContext& context) {
  ImGui::SetCursorPosY((context.ui.px(kStatusHeight) - ImGui::GetFrameHeight()) / 2);
  ButtonOptions options;
  options.look = ButtonLook::Quiet, options.tooltip = "Poses go to " + session.sends_to;
  if (button(context.ui, "status.sending", kSendingWords, options)) context.ask("dialog.open", {"send"});
}

}  // namespace

void draw_status(const app::Session& session, PanelContext& context, float frame_rate) {
  Ui& ui = context.ui;
  const float width = ImGui::GetContentRegionAvail().x, start = ImGui::GetCursorPosX();
  const FontScope small(ui.fonts().small);
  const std::string rate = frame_rate > 0 ? std::to_string(std::lround(frame_rate)) + " fps" : "";
  const bool wide = width > ui.px(560);
  const float rate_width = rate.empty() ? 0 : ui.px(58);
  const float document_width =
      wide ? std::min(ui.px(220), ImGui::CalcTextSize(document_words(session).c_str()).x + ui.px(20)) : 0;
  const bool sends = wide && !session.sends_to.empty();
  const float sending_width = sends ? ImGui::CalcTextSize(kSendingWords).x + ui.px(24) : 0;
  float left = width - rate_width - document_width - sending_width;
  const bool completing = session.source.completing >= 0 && session.jobs.empty();
  if (!session.jobs.empty() || completing) {
    const float job = std::min(ui.px(340), wide ? left * 0.6f : left);
    completing ? draw_completing(session, context, job) : draw_job(session, context, job);
    if (session.jobs.size() > 1 && wide) draw_more_jobs(session, context), left -= ui.px(32);
    left -= job + ImGui::GetStyle().ItemSpacing.x;
    ImGui::SameLine();
  }
  draw_message(session, context, left);
  if (sends) {
    ImGui::SetCursorPosX(start + width - rate_width - document_width - sending_width);
    draw_sending_sign(session, context);
  }
  const float y = (ui.px(kStatusHeight) - ImGui::GetTextLineHeight()) / 2;
  const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
  if (document_width > 0) {
    ImGui::SetCursorPos({start + width - rate_width - document_width + ui.px(10), y});
    text_cut(ui, document_words(session), document_width - ui.px(10));
    ui.mark("status.document");
  }
  if (rate.empty()) return;
  ImGui::SetCursorPos({start + width - ImGui::CalcTextSize(rate.c_str()).x, y});
  ImGui::TextUnformatted(rate.c_str());
  ui.mark("status.rate");
}

}  // namespace understudy::ui
