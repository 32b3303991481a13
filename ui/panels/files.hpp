// Chooses files and folders for commands. Marks: those of FileBrowser.
#pragma once

#include <optional>
#include <string>

#include "ui/panels/panel.hpp"
#include "ui/widgets/file_browser.hpp"

namespace understudy::ui {

/// The purpose of a path.
enum class FilePurpose {
  Anything,       ///< open PATH
  Scan,           ///< source.open PATH
  MotionBody,     ///< the first of source.motion BODY MOTION; the motion is asked for next
  Motion,         ///< the second
  Target,         ///< target.add PATH
  ReplaceTarget,  ///< target.replace K PATH
  Document,       ///< document.open PATH
  SaveDocument,   ///< document.save_as PATH; answers the question about unsaved changes where one waits
  Relocate,       ///< document.relocate OLD NEW
  Export          ///< comes back to the export dialog
};

struct FilesState {
  FileBrowser browser;
  FilePurpose purpose = FilePurpose::Anything;
  std::string first;  ///< Motion: the body; Relocate: the old place
};

/// Opens the browser. `name`: when saving, the path proposed; Relocate: the old place.
void choose_file(const app::Session& session, FilesState& state, FilePurpose purpose,
                 const std::string& name = {});

/// Call every frame while the browser is open: pushes the command. Returns the path of an export.
std::optional<std::string> draw_files(const app::Session& session, PanelContext& context, FilesState& state);

}  // namespace understudy::ui
