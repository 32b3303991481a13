// The window's content: lays out the panels around the views and shows the dialogs.
// Marks of its own: side.tab (.K: the K-th panel of the side), side.edge, views.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ui/panels/arrangement.hpp"
#include "ui/panels/bars.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/export.hpp"
#include "ui/panels/files.hpp"
#include "ui/panels/getting_started.hpp"
#include "ui/panels/start.hpp"
#include "ui/panels/study_forms.hpp"
#include "ui/panels/teach_style.hpp"

namespace understudy::ui {

/// Services from outside the window.
struct WorkspaceServices {
  std::function<void()> draw_views;  ///< inside the current window
  std::vector<SampleCard> samples;
  std::function<std::string()> about;  ///< versions and machine, called when first shown
};

/// One per window. Draw it between Gui::begin_frame and end_frame. Changes nothing itself: pushes commands
/// into the context's queue.
class Workspace {
 public:
  explicit Workspace(WorkspaceServices services = {}) : services_(std::move(services)) {}

  /// `frame_rate`: of the window, frames per second, for the status line.
  void draw(const app::Session& session, PanelContext& context, float frame_rate = 0);

  /// open, open_source, blend_with, map_folder, source_times, source_markers, open_target, replace_target,
  /// open_document, save_as, export, csv, picture, video, compare, teach_style, settings, about, keys,
  /// here (help for what the pointer is on), and those of a study that files.cpp lists; "none" closes.
  /// Throws Error for another name.
  void open_dialog(const app::Session& session, const std::string& name);
  /// Opens a menu of the bar by its name, "" the first, or closes the one that is open.
  /// Throws Error for another name.
  void open_menu(const app::Session& session, const std::string& name);
  /// Shows or hides a panel, "side" or "side_over". A tab of the side panel replaces the one that was on, and
  /// the side panel comes with it, on the start screen too. Throws Error for another name.
  void show_panel(app::Settings& settings, const std::string& name, bool on);
  /// The dialog that is open, or ""; the file browser is "files".
  std::string dialog() const;

  SampleCard& sample(size_t i) { return services_.samples.at(i); }  ///< to give it its picture
  FileBrowser& browser() { return files_.browser; }                 ///< to give it places and previews
  const Rect& views() const { return places_.views; }

 private:
  void draw_centre(const app::Session& session, PanelContext& context);
  void draw_side(const app::Session& session, PanelContext& context);
  void draw_below(const app::Session& session, PanelContext& context);
  void place_parts(const app::Session& session, PanelContext& context);
  void draw_bottom(const app::Session& session, PanelContext& context, float frame_rate);
  void choose_folder(const std::string& path);
  void draw_dialog(const app::Session& session, PanelContext& context);

  WorkspaceServices services_;
  Arrangement places_;
  Parts parts_;
  bool side_on_start_ = false;  ///< asked for while nothing is open
  bool tab_asked_ = false;      ///< since the last frame
  std::string dialog_, about_;
  ExportState export_;
  StudyFormState study_form_;
  CompareState compare_;
  TeachState teach_;
  FilesState files_;
  NoticesState notices_;
  GettingStartedState getting_started_;
  MenuKeys menu_keys_;
  std::optional<Explanation> here_;  ///< what help shows
};

}  // namespace understudy::ui
