// Chooses files and folders for commands. Marks: those of FileBrowser.
#pragma once

#include <optional>
#include <string>

#include "ui/panels/panel.hpp"
#include "ui/widgets/file_browser.hpp"

namespace understudy::ui {

/// The purpose of a path: a row of the table in files.cpp.
enum class FilePurpose {
  Anything,
  Source,      ///< an SMPL-format body is the first of two: its motion is asked for next
  BodyMotion,  ///< the second
  BlendWith,
  MapFolder,
  SourceTimes,
  SourceMarkers,
  ExportBones,
  SecondBody,
  ExportSecondBody,
  Target,
  ReplaceTarget,
  LoadProportions,
  SaveProportions,
  Style,
  Document,
  SaveDocument,  ///< answers the question about unsaved changes where one waits
  Relocate,
  OpenStudy,
  SaveStudy,       ///< as SaveDocument
  StudyFiles,      ///< a condition of its own
  StudyAnimation,  ///< of the chosen condition
  StudyMotion,
  StudyTarget,
  StudyAnswers,
  TrialsTable,  ///< and those after it: the list of trials
  TrialsCsv,
  TrialsJsPsych,
  TrialsPsychoPy,
  Stimuli,
  Folder,     ///< comes back to the dialog that asked
  Reference,  ///< comes back to the export dialog: poses that the camera lays a take onto
  Export      ///< comes back to the export dialog
};

struct FilesState {
  FileBrowser browser;
  FilePurpose purpose = FilePurpose::Anything;
  std::string first;  ///< BodyMotion: the body; Relocate: the old place
};

/// The purpose of a dialog that dialog.open names ("open_source"); none where it asks for no path.
std::optional<FilePurpose> purpose_of(const std::string& dialog);
/// The dialog that asks for the path of a command; null where there is none.
const char* file_dialog_for(const std::string& command);

/// The folder that the browser gave, or that of the file that it gave: one of its files stands for a folder.
std::string folder_of_choice(const std::string& path);

/// Opens the browser. `name`: when saving, the path proposed; Relocate: the old place;
/// BodyMotion: the body; Folder: that of now.
void choose_file(const app::Session& session, FilesState& state, FilePurpose purpose,
                 const std::string& name = {});

/// Call every frame while the browser is open: pushes the command. Returns the path of an export.
std::optional<std::string> draw_files(const app::Session& session, PanelContext& context, FilesState& state);

}  // namespace understudy::ui
