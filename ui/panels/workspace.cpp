#include "ui/panels/workspace.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>

#include "retarget/base/error.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/inspector.hpp"
#include "ui/panels/keys.hpp"
#include "ui/panels/layers.hpp"
#include "ui/panels/settings.hpp"
#include "ui/panels/status.hpp"
#include "ui/panels/top_bar.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

constexpr std::array<const char*, 4> kTabs = {"inspector", "layers", "edit", "metrics"};

/// A window without any decoration that fills a place.
class Pane {
 public:
  Pane(Ui& ui, const char* name, const Rect& place, ImVec2 padding, const ImVec4& background,
       bool scrolls = false) {
    ImGui::SetNextWindowPos(place.min);
    ImGui::SetNextWindowSize({place.width(), place.height()});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(padding.x), ui.px(padding.y)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    const ColorScope color(ImGuiCol_WindowBg, background);
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                             ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                             ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
    if (!scrolls) flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    ImGui::Begin(name, nullptr, flags);
    ImGui::PopStyleVar(4);
  }
  ~Pane() { ImGui::End(); }
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;
};

bool tab_on(const app::Session& session, size_t tab) {
  const auto found = session.settings.panels.find(kTabs[tab]);
  return found != session.settings.panels.end() && found->second;
}

/// Menus and lists close by Escape; dialogs do so themselves.
void close_menu_by_escape() {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  if (context.OpenPopupStack.empty() || !key_pressed(render::Key::Escape, false)) return;
  const ImGuiWindow* top = context.OpenPopupStack.back().Window;
  if (top == nullptr || (top->Flags & ImGuiWindowFlags_Modal) != 0) return;
  ImGui::ClosePopupToLevel(context.OpenPopupStack.Size - 1, true);
}

/// A dialog that vanished without closing must not keep the rest from being used.
void close_forgotten_dialog(bool any_drawn) {
  if (!any_drawn && ImGui::GetTopMostPopupModal() != nullptr) ImGui::ClosePopupToLevel(0, true);
}

}  // namespace

void Workspace::draw(const app::Session& session, PanelContext& context, float frame_rate) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const bool open = has_document(session), narrow = is_narrow(display.x, context.ui.scale());
  parts_.side = open && panel_shown(session, narrow ? "side_over" : "side");
  parts_.timeline = open && panel_shown(session, "timeline");
  parts_.log = panel_shown(session, "log");
  places_ = arrange(display, context.ui.scale(), parts_);
  follow_tabs(session, context);
  if (!places_.top.empty()) draw_top_bar(session, context, places_.top);
  draw_centre(session, context);
  draw_bottom(session, context, frame_rate);
  draw_side(session, context);
  close_menu_by_escape();
  draw_dialog(session, context);
  draw_notices(session, context, notices_, places_.views);
  ask_for_keys(session, context);
}

/// The views, or the start screen, and the log below.
void Workspace::draw_centre(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!places_.views.empty()) {
    const bool open = has_document(session);
    const Pane pane(ui, "##views", places_.views, open ? ImVec2(0, 0) : ImVec2(16, 8), ui.theme().backdrop,
                    !open);
    ImGui::BringWindowToDisplayBack(ImGui::GetCurrentWindow());  // the side panel may lie over it
    ui.mark("views", places_.views);
    if (!open)
      draw_start(session, context, services_.samples);
    else if (services_.draw_views)
      services_.draw_views(places_.views.min, {places_.views.width(), places_.views.height()});
  }
  if (places_.log.empty()) return;
  const Pane pane(ui, "##log", places_.log, {12, 6}, ui.theme().panel);
  draw_log(session, context, log_);
}

void Workspace::draw_side(const app::Session& session, PanelContext& context) {
  if (places_.side.empty()) return;
  Ui& ui = context.ui;
  draw_side_edge(context);
  const Pane pane(ui, "##side", places_.side, {12, 8}, ui.theme().panel);
  int tab = tab_;
  if (segmented(ui, "side.tab", {"Inspector", "Layers", "Edit", "Metrics"}, tab)) {
    context.ask("panel.show", {kTabs[tab], "on"});
    tab_ = tab;
  }
  ImGui::Dummy({0, ui.px(2)});
  if (ImGui::BeginChild(kTabs[tab_], {0, 0}, false, ImGuiWindowFlags_AlwaysVerticalScrollbar)) {
    if (tab_ == 0) draw_inspector(session, context);
    if (tab_ == 1) draw_layers(session, context);
    if (tab_ == 2) draw_edit(session, context, edit_);
    if (tab_ == 3) {
      timeline_.follow(session);
      draw_metrics(session, context, metrics_, timeline_);
    }
  }
  ImGui::EndChild();
}

void Workspace::draw_side_edge(PanelContext& context) {
  if (places_.side_edge.empty()) return;
  const Pane pane(context.ui, "##edge", places_.side_edge, {0, 0}, context.ui.theme().panel);
  SplitterOptions options;
  options.reversed = true, options.min = 260, options.max = 640;
  splitter(context.ui, "side.edge", parts_.side_width, options);
}

void Workspace::draw_bottom(const app::Session& session, PanelContext& context, float frame_rate) {
  Ui& ui = context.ui;
  if (!places_.timeline.empty()) {
    const Pane pane(ui, "##timeline", places_.timeline, {12, 8}, ui.theme().panel);
    draw_timeline(session, context, timeline_);
  }
  if (places_.status.empty()) return;
  const Pane pane(ui, "##status", places_.status, {12, 3}, ui.theme().raised);
  draw_status(session, context, frame_rate);
}

/// The tab that is on; where another was turned on (by a script, the menu), that one. Only one stays on.
void Workspace::follow_tabs(const app::Session& session, PanelContext& context) {
  int turned_on = -1;
  for (size_t i = 0; i < kTabs.size(); ++i)
    if (tab_on(session, i) && static_cast<int>(i) != tab_) turned_on = i;
  if (turned_on < 0) return;
  if (tab_on(session, tab_)) context.ask("panel.show", {kTabs[tab_], "off"});
  tab_ = turned_on;
  const char* side = places_.narrow ? "side_over" : "side";
  if (!panel_shown(session, side)) context.ask("panel.show", {side, "on"});
}

std::string Workspace::dialog() const {
  return files_.browser.is_open() ? "files" : dialog_;
}

void Workspace::open_dialog(const app::Session& session, const std::string& name) {
  struct Chooser {
    const char* name;
    FilePurpose purpose;
  };
  constexpr Chooser kChoosers[] = {{"open", FilePurpose::Anything},
                                   {"open_scan", FilePurpose::Scan},
                                   {"open_motion", FilePurpose::MotionBody},
                                   {"open_target", FilePurpose::Target},
                                   {"replace_target", FilePurpose::ReplaceTarget},
                                   {"open_document", FilePurpose::Document},
                                   {"save_as", FilePurpose::SaveDocument}};
  for (const Chooser& chooser : kChoosers)
    if (name == chooser.name) return choose_file(session, files_, chooser.purpose);
  const bool exports = name == "export" || name == "csv" || name == "picture" || name == "video";
  if (exports)
    begin_export(export_,
                 name == "picture" ? ExportKind::Picture
                 : name == "video" ? ExportKind::Video
                                   : ExportKind::Animation,
                 name == "csv" ? figures_format() : 0);
  if (name == "about" && services_.about) about_ = services_.about();
  const auto known = {"compare", "settings", "about", "keys", "none"};
  US_CHECK(exports || std::find(known.begin(), known.end(), name) != known.end(), "there is no dialog ",
           name);
  dialog_ = exports ? "export" : name == "none" ? "" : name;
}

void Workspace::draw_dialog(const app::Session& session, PanelContext& context) {
  const bool any = !session.errors.empty() || session.question || !dialog().empty();
  if (draw_error(session, context)) {
    // One after the other: what else is open comes back when the error was read.
  } else if (files_.browser.is_open() || session.question) {
    draw_question_or_browse(session, context);
  } else if (dialog_ == "export") {
    draw_export_dialog(session, context);
  } else {
    bool stays = true;
    if (dialog_ == "settings") stays = draw_settings(session, context);
    if (dialog_ == "about") stays = draw_about(context, about_);
    if (dialog_ == "keys") stays = draw_keys(session, context);
    if (dialog_ == "compare") stays = draw_compare(session, context, compare_);
    if (!stays) dialog_.clear();
  }
  close_forgotten_dialog(any);
}

void Workspace::draw_question_or_browse(const app::Session& session, PanelContext& context) {
  if (files_.browser.is_open()) {
    const auto path = draw_files(session, context, files_);
    if (path) export_.path = *path, export_.agreed = *path;
    return;
  }
  const QuestionAnswer answer = draw_question(session, context);
  if (answer.save_as) choose_file(session, files_, FilePurpose::SaveDocument);
  if (!answer.look_for.empty()) choose_file(session, files_, FilePurpose::Relocate, answer.look_for);
}

void Workspace::draw_export_dialog(const app::Session& session, PanelContext& context) {
  const ExportAnswer answer = draw_export(session, context, export_);
  if (answer.browse) choose_file(session, files_, FilePurpose::Export, export_.path);
  if (!answer.stays) dialog_.clear();
}

}  // namespace understudy::ui
