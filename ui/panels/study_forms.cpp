#include "ui/panels/study_forms.hpp"

#include <algorithm>
#include <filesystem>

#include "app/session/study_showing.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace fs = std::filesystem;
namespace {

void draw_folders(Ui& ui, const app::Session& session, StudyFormState& state, FilesState& files) {
  const auto browse = [&](bool clips) {
    state.browses_clips = clips;
    choose_file(session, files, FilePurpose::Folder, clips ? state.clips : state.folder);
  };
  if (folder_row(ui, {"study_form.clips", "Clips", "The folder into which the stimuli were rendered"},
                 "render the stimuli first", state.clips))
    browse(true);
  const Control folder{"study_form.folder", state.runs ? "Answers" : "Folder",
                       state.runs ? "The folder of the answers, a file of each participant"
                                  : "The folder for browsers: index.html and all that it needs"};
  if (folder_row(ui, folder, "", state.folder)) browse(false);
}

void draw_participant(Ui& ui, StudyFormState& state) {
  row(ui, "Participant", "Their file of answers is called so, and their order of trials follows from it");
  text_field(ui, "study_form.participant", state.participant);
}

void ask_for_it(PanelContext& context, const StudyFormState& state) {
  if (state.runs)
    context.ask("study.run", {state.participant, state.clips, state.folder});
  else
    context.ask("study.web", {state.folder, state.clips});
}

}  // namespace

bool begin_study_form(const app::Session& session, StudyFormState& state, const std::string& dialog) {
  if (dialog != "study_web" && dialog != "study_run") return false;
  const app::StudyFolders folders = app::folders_of(session.study);
  state = {};
  state.runs = dialog == "study_run";
  state.clips = folders.clips;
  const fs::path file = session.study.path;
  if (state.runs)
    state.folder = folders.answers, state.participant = app::next_participant(folders.answers);
  else if (!file.empty())
    state.folder = fs::path(file).replace_extension().string() + " web";
  return true;
}

void choose_study_folder(StudyFormState& state, const std::string& path) {
  const std::string folder = folder_of_choice(path);
  (state.browses_clips ? state.clips : state.folder) = folder;
  if (state.runs && !state.browses_clips) state.participant = app::next_participant(folder);
}

bool draw_study_form(const app::Session& session, PanelContext& context, StudyFormState& state,
                     FilesState& files) {
  Ui& ui = context.ui;
  if (!session.study.study) return false;
  if (!begin_dialog(ui, "study_form", state.runs ? "Run the study" : "Web page of the study", 460))
    return true;
  hint(ui, state.runs ? "A participant sees the trials and answers them, on the whole screen."
                      : "A folder that runs the study in any browser, from a file or from a web server.");
  if (state.runs) draw_participant(ui, state);
  draw_folders(ui, session, state, files);
  const std::string problem = app::why_not_shown(session.study);
  if (!problem.empty()) {
    warning_sentence(ui, "Not yet: " + problem + ".");
    ui.mark("study_form.problem");
  }
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions apply;
  apply.look = ButtonLook::Main;
  apply.disabled = !problem.empty() || state.clips.empty() || state.folder.empty() ||
                   (state.runs && state.participant.empty());
  bool stays = !buttons.add(ui, "study_form.cancel", "Cancel", {});
  if (buttons.add(ui, "study_form.apply", state.runs ? "Run" : "Make", apply))
    ask_for_it(context, state), stays = false;
  return finish_dialog(stays);
}

}  // namespace understudy::ui
