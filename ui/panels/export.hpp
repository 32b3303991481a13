// The export dialog: animations, figures, pictures, video.
// Marks: export.format, export.take, export.rig, export.influences, export.morphs, export.reduce,
// export.in_place, export.t_pose, export.keep_clips, export.all_takes, export.clip.TAKE, export.path,
// export.browse, export.size, export.width, export.height, export.all, export.transparent, export.save,
// export.cancel; export.overwrite.yes and .cancel.
#pragma once

#include <set>
#include <string>

#include "app/session/take_export.hpp"
#include "ui/panels/files.hpp"

namespace understudy::ui {

enum class ExportKind { Animation, Picture, Video };

struct ExportState {
  ExportKind kind = ExportKind::Animation;
  int format = 0;             ///< of an animation: one of app::export_formats(), or behind them the figures
  app::ExportChoice choice;   ///< of an animation, kept for the next one; its format is not used
  bool all_takes = false;     ///< of the selected take's target, as clips of one file
  std::set<size_t> left_out;  ///< of those
  std::string path;           ///< empty: proposes one
  int width = 1920, height = 1080;
  bool all = true;           ///< all views; false: the active one
  bool transparent = false;  ///< pictures
  bool asking = false;       ///< whether to write over the file that is there
  std::string agreed;        ///< the path that may be written over, as the browser has asked
};

/// Opens the dialog of that name, with a new path to propose: export, csv, picture or video. False, and nothing
/// changed, for another name.
bool begin_export(ExportState& state, const std::string& dialog);

/// A dialog; call every frame while it is open. False once done or cancelled. Opens the browser where the user
/// wants to choose the path.
bool draw_export(const app::Session& session, PanelContext& context, ExportState& state, FilesState& files);

}  // namespace understudy::ui
