// The dialog that teaches a style: from recordings of how somebody moves now, and of how they shall move.
// Marks: teach_style.from, .to (.browse, .holds), .name, .licence, .attribution, .joints (.K), .replace,
// .forget, .restore, .problem, .consent, .apply, .cancel.
#pragma once

#include <memory>
#include <string>

#include "app/run/recordings_look.hpp"
#include "ui/panels/files.hpp"

namespace understudy::ui {

/// A folder as it is typed, and what is in it once it is typed.
struct TaughtFolder {
  std::string path;
  std::string seen;       ///< the path of the frame before
  double seen_since = 0;  ///< ImGui's seconds
  std::string looked_at;
  std::unique_ptr<app::RecordingsLook> look;  ///< null: at none yet
};

struct TeachState {
  TaughtFolder from, to;
  std::string name, licence = "own recordings", attribution;
  int joints = 0;                ///< a row of the table in teach_style.cpp
  bool replace = false;          ///< the style of that name
  bool browses_to = false;       ///< which folder the browser is open for
  std::string checked, problem;  ///< the name last looked at, and why it is none
  std::string asked;             ///< the command that was pushed last, as a line
};

/// Takes the folder that the browser gave.
void choose_manner_folder(TeachState& state, const std::string& path);
/// Whether what the dialog asked for last is among the errors: it comes back then, with all its choices.
/// True once.
bool teaching_failed(const app::Session& session, TeachState& state);

/// A dialog; call every frame while it is open. False once done or cancelled. Opens the browser for folders.
bool draw_teach_style(const app::Session& session, PanelContext& context, TeachState& state,
                      FilesState& files);

}  // namespace understudy::ui
