// The dialogs that bring a study to its participants: a folder for browsers, or a run on this screen.
// Marks: study_form.participant, .clips, .folder, .clips.browse, .folder.browse, .problem, .apply, .cancel.
#pragma once

#include <string>

#include "ui/panels/files.hpp"

namespace understudy::ui {

struct StudyFormState {
  bool runs = false;        ///< a participant; else it makes a folder for browsers
  std::string participant;  ///< empty: the first whose answers are not in the folder
  std::string clips;
  std::string folder;          ///< of the answers, or for browsers
  bool browses_clips = false;  ///< the browser was opened for them
};

/// Opens the dialog of that name, study_web or study_run, with the folders used last. False, and nothing
/// changed, for another name.
bool begin_study_form(const app::Session& session, StudyFormState& state, const std::string& dialog);
/// Takes the folder that the browser gave.
void choose_study_folder(StudyFormState& state, const std::string& path);

/// A dialog; call every frame while it is open. False once done or cancelled.
bool draw_study_form(const app::Session& session, PanelContext& context, StudyFormState& state,
                     FilesState& files);

}  // namespace understudy::ui
