#include "ui/panels/start.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

constexpr float kCard = 196, kPicture = 112, kCardHeight = 170;  // at scale 1

/// A picture that keeps its shape and fills the rectangle, or an icon.
void draw_picture(Ui& ui, const SampleCard& card, const Rect& rect) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float corner = ui.px(6);
  list.AddRectFilled(rect.min, rect.max, color(ui.theme().backdrop), corner, ImDrawFlags_RoundCornersTop);
  if (card.picture != nullptr) {
    list.AddImageRounded(card.picture, rect.min, rect.max, {0, 0}, {1, 1}, IM_COL32_WHITE, corner,
                         ImDrawFlags_RoundCornersTop);
    return;
  }
  const float side = ui.px(40);
  draw_icon(list, Icon::Person, {rect.at(0.5f, 0).x - side / 2, rect.at(0, 0.5f).y - side / 2}, side,
            color(ui.theme().text_faint));
}

bool draw_card(Ui& ui, const std::string& name, const SampleCard& card, float width) {
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {width, ui.px(kCardHeight)});
  ui.mark(name);
  ui.stop(name);
  const Rect rect{ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(rect.min, rect.max, color(hovered ? ui.theme().field : ui.theme().raised), ui.px(6));
  draw_picture(ui, card, {rect.min, {rect.max.x, rect.min.y + ui.px(kPicture)}});
  list.AddRect(rect.min, rect.max, color(hovered ? ui.theme().accent_hover : ui.theme().line), ui.px(6));
  const float x = rect.min.x + ui.px(10), room = width - ui.px(20);
  {
    const FontScope strong(ui.fonts().strong);
    list.AddText({x, rect.min.y + ui.px(kPicture + 8)}, color(ui.theme().text),
                 cut_to(card.title, room).c_str());
  }
  const FontScope small(ui.fonts().small);
  list.AddText({x, rect.min.y + ui.px(kPicture + 31)}, color(ui.theme().text_dim),
               cut_to(card.caption, room).c_str());
  tooltip(ui, card.caption);
  return clicked;
}

void draw_samples(PanelContext& context, const std::vector<SampleCard>& samples) {
  Ui& ui = context.ui;
  const float gap = ImGui::GetStyle().ItemSpacing.x + ui.px(4), width = ImGui::GetContentRegionAvail().x;
  const float card = std::min(ui.px(kCard), std::max(1.f, width));
  const int a_line = std::max(1, static_cast<int>((width + gap) / (card + gap)));
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i % a_line != 0) ImGui::SameLine(0, gap);
    if (!draw_card(ui, "start.sample." + std::to_string(i), samples[i], card)) continue;
    context.ask("open", samples[i].paths);
    for (const std::string& line : samples[i].then) push(context, {line, ""});
  }
}

void heading(Ui& ui, const std::string& words) {
  ImGui::Dummy({0, ui.px(10)});
  const FontScope strong(ui.fonts().strong);
  text_cut(ui, words);
}

void draw_openers(PanelContext& context) {
  Ui& ui = context.ui;
  struct Opener {
    const char *name, *label, *dialog;
  };
  constexpr Opener kOpeners[] = {{"start.open_source", "Open scan or motion\u2026", "open_source"},
                                 {"start.open_target", "Open target\u2026", "open_target"},
                                 {"start.open_document", "Open document\u2026", "open_document"}};
  const float end = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
  for (const Opener& opener : kOpeners) {
    const float width = ImGui::CalcTextSize(opener.label).x + ui.px(28);
    if (&opener != kOpeners) {
      ImGui::SameLine();
      if (ImGui::GetCursorScreenPos().x + width > end) ImGui::NewLine();
    }
    ButtonOptions options;
    options.look = &opener == kOpeners ? ButtonLook::Main : ButtonLook::Plain;
    if (button(ui, opener.name, opener.label, options)) context.ask("dialog.open", {opener.dialog});
  }
}

struct RecentList {
  const char *title, *name, *command;
  const std::vector<std::string>& entries;
};

void draw_recent(const RecentList& recent, PanelContext& context) {
  if (recent.entries.empty()) return;
  heading(context.ui, recent.title);
  const IdScope list(recent.name);
  for (size_t i = 0; i < recent.entries.size(); ++i) {
    const std::vector<std::string> paths = app::paths_of_recent(recent.entries[i]);
    const bool is_pair = paths.size() > 1;
    ButtonOptions options;
    options.look = ButtonLook::Quiet, options.tooltip = recent.entries[i];
    const std::string name =
        is_pair ? file_name(paths[1]) + " (" + file_name(paths[0]) + ")" : file_name(paths[0]);
    const std::string label = cut_to(name, ImGui::GetContentRegionAvail().x - context.ui.px(16));
    if (button(context.ui, recent.name + ("." + std::to_string(i)), label, options))
      context.ask(is_pair ? "source.motion" : recent.command, paths);
  }
}

}  // namespace

void draw_start(const app::Session& session, PanelContext& context, const std::vector<SampleCard>& samples) {
  Ui& ui = context.ui;
  const float all = ImGui::GetContentRegionAvail().x, width = std::min(all, ui.px(840));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::floor((all - width) / 2));
  ImGui::BeginChild("##start", {width, 0});
  ImGui::Dummy({0, std::min(ui.px(36), 0.06f * ImGui::GetContentRegionAvail().y)});
  {
    const FontScope title(ui.fonts().title);
    text_cut(ui, "Any body, any motion");
  }
  {
    const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
    paragraph("Drop a scan or motion and a character here.");
  }
  ImGui::Dummy({0, ui.px(6)});
  draw_openers(context);
  if (!samples.empty()) {
    heading(ui, "Samples");
    draw_samples(context, samples);
  }
  const app::Settings& settings = session.settings;
  draw_recent({"Recent", "start.recent", "document.open", settings.recent}, context);
  draw_recent({"Recent studies", "start.recent_study", "study.open", settings.recent_studies}, context);
  draw_recent({"Recent scans and motions", "start.recent_source", "open", settings.recent_sources}, context);
  draw_recent({"Recent targets", "start.recent_target", "open", settings.recent_targets}, context);
  ImGui::EndChild();
}

}  // namespace understudy::ui
