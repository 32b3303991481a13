#include "ui/panels/workspace.hpp"
#include "ui/panels/sending.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/bars.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/help.hpp"
#include "ui/panels/menus.hpp"
#include "ui/panels/panels.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

/// Those of one dock; of the strip below the views those that are shown.
std::vector<const Panel*> panels_in(Panel::Dock dock, const app::Session& session) {
  std::vector<const Panel*> found;
  for (const Panel& panel : panels())
    if (panel.dock == dock && (dock != Panel::Dock::Below || panel_shown(session, panel.name)))
      found.push_back(&panel);
  return found;
}

/// A window without any decoration that fills a place.
class Frame {
 public:
  Frame(Ui& ui, const char* name, const Rect& place, ImVec2 padding, const ImVec4& background,
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
  ~Frame() { ImGui::End(); }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;
};

/// A dialog that vanished without closing must not keep the rest from being used.
void close_forgotten_dialog(bool any_drawn) {
  if (!any_drawn && ImGui::GetTopMostPopupModal() != nullptr) ImGui::ClosePopupToLevel(0, true);
}

}  // namespace

/// A tab that was asked for is shown whatever the window's width has become meanwhile.
void Workspace::place_parts(const app::Session& session, PanelContext& context) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const bool open = has_document(session);
  const char* const side = is_narrow(display.x, context.ui.scale()) ? "side_over" : "side";
  if (std::exchange(tab_asked_, false) && !panel_shown(session, side))
    context.ask("panel.show", {side, "on"});
  if (open || session.study.study) side_on_start_ = false;
  parts_.side = (open || session.study.study || side_on_start_) && panel_shown(session, side);
  parts_.timeline = open && panel_shown(session, "timeline");
  parts_.below = !panels_in(Panel::Dock::Below, session).empty();
  places_ = arrange(display, context.ui.scale(), parts_);
}

void Workspace::draw(const app::Session& session, PanelContext& context, float frame_rate) {
  place_parts(session, context);
  if (places_.top.empty())
    menu_keys_ = {};  // no menu will open
  else
    draw_top_bar(session, context, {places_.top, parts_.side}, menu_keys_);
  draw_centre(session, context);
  draw_below(session, context);
  draw_bottom(session, context, frame_rate);
  draw_side(session, context);
  if (session.map.performance && !panel_shown(session, "motion_map")) context.ask("map.perform");
  const std::string before = dialog();
  const bool asks = !session.errors.empty() || session.question || !before.empty();
  draw_dialog(session, context);
  draw_notices(session, context, notices_, places_.views);
  draw_getting_started(session, context, getting_started_, asks);
  // The key that closed a dialog, or led from one menu to the next, does nothing else.
  if (!asks && menu_keys_.wanted.empty()) {
    if (context.ui.focus().alt_tapped()) context.ask("menu.open");
    ask_for_keys(session, context);
  }
  // What is typed from now on is for the dialog that comes.
  const auto opens = [](const auto& asked) {
    return asked.first == "dialog.open" || asked.first == "help.keys";
  };
  const bool opened = dialog() != before && !dialog().empty();
  if (opened || std::any_of(context.queue.begin(), context.queue.end(), opens))
    context.ui.focus().await_dialog();
}

void Workspace::open_menu(const app::Session& session, const std::string& name) {
  const std::vector<Menu> all = menus(session);
  const auto known = [&](const Menu& menu) { return menu.name == name; };
  US_CHECK(name.empty() || std::any_of(all.begin(), all.end(), known), "there is no menu ", name);
  menu_keys_.wanted = name.empty() ? all.front().name : name;
}

/// The views, or the start screen.
void Workspace::draw_centre(const app::Session& session, PanelContext& context) {
  if (places_.views.empty()) return;
  Ui& ui = context.ui;
  const bool open = has_document(session);
  const Frame frame(ui, "##views", places_.views, open ? ImVec2(0, 0) : ImVec2(16, 8), ui.theme().backdrop,
                    !open);
  ImGui::BringWindowToDisplayBack(ImGui::GetCurrentWindow());  // the side panel may lie over it
  ui.mark("views", places_.views);
  if (open) ui.explain({places_.views, "Views", views_help(session.tool)});
  if (!open)
    draw_start(session, context, services_.samples);
  else if (services_.draw_views)
    services_.draw_views();
}

/// The panels of the strip below the views, side by side.
void Workspace::draw_below(const app::Session& session, PanelContext& context) {
  if (places_.below.empty()) return;
  const auto shown = panels_in(Panel::Dock::Below, session);
  for (size_t i = 0; i < shown.size(); ++i) {
    const auto edge = [&](size_t k) {
      return std::round(places_.below.at(static_cast<float>(k) / static_cast<float>(shown.size()), 0).x);
    };
    const Rect place{{edge(i), places_.below.min.y}, {edge(i + 1), places_.below.max.y}};
    const Frame frame(context.ui, shown[i]->name, place, {12, 6}, context.ui.theme().panel);
    context.ui.explain({place, shown[i]->title, shown[i]->help, shown[i]->keys});
    shown[i]->draw(session, context);
  }
}

void Workspace::draw_side(const app::Session& session, PanelContext& context) {
  if (places_.side.empty()) return;
  Ui& ui = context.ui;
  if (!places_.side_edge.empty()) {
    const Frame edge(ui, "##edge", places_.side_edge, {0, 0}, ui.theme().panel);
    splitter(ui, "side.edge", parts_.side_width, 260, 640);
  }
  const Frame frame(ui, "##side", places_.side, {12, 8}, ui.theme().panel);
  const auto tabs = panels_in(Panel::Dock::Side, session);
  const Panel& shown = shown_tab(session);
  ui.explain({places_.side, shown.title, shown.help, shown.keys});
  std::vector<std::string> titles;
  titles.reserve(tabs.size());
  for (const Panel* panel : tabs) titles.push_back(panel->title);
  int chosen = static_cast<int>(std::find(tabs.begin(), tabs.end(), &shown) - tabs.begin());
  if (segmented(ui, "side.tab", titles, chosen)) context.ask("panel.show", {tabs[chosen]->name, "on"});
  ImGui::Dummy({0, ui.px(2)});
  if (ImGui::BeginChild(shown.name, {0, 0}, false, ImGuiWindowFlags_AlwaysVerticalScrollbar))
    shown.draw(session, context);
  ImGui::EndChild();
}

void Workspace::draw_bottom(const app::Session& session, PanelContext& context, float frame_rate) {
  Ui& ui = context.ui;
  if (!places_.timeline.empty()) {
    const Frame frame(ui, "##timeline", places_.timeline, {12, 8}, ui.theme().panel);
    for (const Panel* panel : panels_in(Panel::Dock::Timeline, session)) {
      ui.explain({places_.timeline, panel->title, panel->help, panel->keys});
      panel->draw(session, context);
    }
  }
  if (places_.status.empty()) return;
  const Frame frame(ui, "##status", places_.status, {12, 3}, ui.theme().raised);
  ui.explain({places_.status, "Status",
              "What is being done now, the newest message, and what the mouse does in the views."});
  draw_status(session, context, frame_rate);
}

void Workspace::show_panel(app::Settings& settings, const std::string& name, bool on) {
  const bool is_side = name == "side" || name == "side_over";
  const bool tab = !is_side && panel_of(name).dock == Panel::Dock::Side && on;
  if (is_side || tab) side_on_start_ = on;
  if (tab) {
    tab_asked_ = true;
    for (const Panel& panel : panels())
      if (panel.dock == Panel::Dock::Side) settings.panels.erase(panel.name);
    settings.panels[places_.narrow ? "side_over" : "side"] = true;
  }
  settings.panels[name] = on;
}

std::string Workspace::dialog() const {
  return files_.browser.is_open() ? "files" : dialog_;
}

void Workspace::open_dialog(const app::Session& session, const std::string& name) {
  if (const auto purpose = purpose_of(name)) return choose_file(session, files_, *purpose);
  const bool exports = begin_export(session, export_, name);
  const bool shows_study = begin_study_form(session, study_form_, name);
  if (name == "about" && services_.about) about_ = services_.about();
  const auto known = {"compare", "teach_style", "settings", "send", "about", "keys", "here", "none"};
  US_CHECK(exports || shows_study || std::find(known.begin(), known.end(), name) != known.end(),
           "there is no dialog ", name);
  dialog_ = exports ? "export" : shows_study ? "study_form" : name == "none" ? "" : name;
  here_.reset();
}

/// For the dialog that asked.
void Workspace::choose_folder(const std::string& path) {
  if (dialog_ == "study_form") choose_study_folder(study_form_, path);
  if (dialog_ == "teach_style") choose_manner_folder(teach_, path);
}

void Workspace::draw_dialog(const app::Session& session, PanelContext& context) {
  if (export_failed(session, export_)) dialog_ = "export";
  if (teaching_failed(session, teach_)) dialog_ = "teach_style";
  const bool any = !session.errors.empty() || session.question || !dialog().empty();
  if (draw_error(session, context)) {
    // One after the other: what else is open comes back when the error was read.
  } else if (files_.browser.is_open()) {
    const auto path = draw_files(session, context, files_);
    if (path && files_.purpose == FilePurpose::Export) choose_path(export_, *path);
    if (path && files_.purpose == FilePurpose::Reference) choose_reference(export_, *path);
    if (path && files_.purpose == FilePurpose::Folder) choose_folder(*path);
  } else if (session.question) {
    draw_question(session, context, files_);
  } else {
    bool stays = true;
    if (dialog_ == "export") stays = draw_export(session, context, export_, files_);
    if (dialog_ == "study_form") stays = draw_study_form(session, context, study_form_, files_);
    if (dialog_ == "settings") stays = draw_settings(session, context);
    if (dialog_ == "send") stays = draw_sending(session, context);
    if (dialog_ == "about") stays = draw_about(context, about_);
    if (dialog_ == "keys") stays = draw_keys(session, context);
    if (dialog_ == "here") stays = draw_help_here(context, here_);
    if (dialog_ == "teach_style") stays = draw_teach_style(session, context, teach_, files_);
    if (dialog_ == "compare") stays = draw_compare(session, context, compare_);
    if (!stays) dialog_.clear();
  }
  close_forgotten_dialog(any);
}

}  // namespace understudy::ui
