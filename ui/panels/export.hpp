// The export dialog: animations, figures, pictures, video.
// Marks: export.preset, export.preset.words, export.format, export.takes (.0 the current one, .1 a file each,
// .2 one file), export.take, export.bones, export.influences, export.morphs, export.reduce,
// export.in_place, export.root_motion, export.t_pose, export.keep_clips, export.clip.TAKE, export.path,
// export.browse, export.size, export.width, export.height, export.all, export.transparent, export.as,
// export.save, export.cancel; export.overwrite.yes and .cancel.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "app/session/take_export.hpp"
#include "ui/panels/files.hpp"

namespace understudy::ui {

enum class ExportKind { Animation, Picture, Video };
/// Which takes an animation is of.
enum class ExportTakes {
  Current,
  Files,   ///< all of them, a file each
  OneFile  ///< those that fit the current one, in one file
};

struct ExportState {
  ExportKind kind = ExportKind::Animation;
  int format = 0;            ///< of an animation: one of app::export_formats(), or behind them the figures
  app::ExportChoice choice;  ///< of an animation, kept for the next one; its format is not used
  ExportTakes takes = ExportTakes::Current;
  std::set<size_t> left_out;  ///< of the one file
  std::string path;           ///< whole, with its suffix; of a file each their folder
  bool is_flat = false;       ///< the current take is of 2D poses
  int flat_as = 0;            ///< what such a take is written as, a place in kFlatSuffixes
  bool lays_onto = false;     ///< pose pictures: the camera lays the take onto a reference's poses
  bool typed = false;         ///< the path, or chosen; else it follows the take
  int width = 1920, height = 1080;
  bool all = true;                      ///< all views; false: the active one
  bool transparent = false;             ///< pictures
  bool as_pictures = false;             ///< a video: a folder of them
  std::vector<std::string> in_the_way;  ///< names of files that would be replaced, asked about; empty: none
  std::string agreed;                   ///< the path that may be written over, as the browser has asked
  std::string asked;                    ///< the command that was pushed last, as a line
};

/// Opens the dialog of that name, with a new path to propose and the format used last: export, csv, picture
/// or video. False, and nothing changed, for another name.
bool begin_export(const app::Session& session, ExportState& state, const std::string& dialog);
/// Takes the path that the browser gave: of the export, or of the poses it is laid onto.
void choose_path(ExportState& state, const std::string& path);
void choose_reference(ExportState& state, const std::string& path);
/// Whether what the dialog asked for last is among the errors: it comes back then, with all its choices.
/// True once.
bool export_failed(const app::Session& session, ExportState& state);

/// A dialog; call every frame while it is open. False once done or cancelled. Opens the browser where the
/// user wants to choose the path.
bool draw_export(const app::Session& session, PanelContext& context, ExportState& state, FilesState& files);

}  // namespace understudy::ui
