#include "ui/panels/files.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "app/session/take_export.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"

namespace understudy::ui {
namespace fs = std::filesystem;
namespace {

struct FileDialog {
  const char* name;     ///< for dialog.open; empty: only the window opens it
  const char* command;  ///< as a line of a script; gets the path as its last argument
  const char *title, *accept;
  FileKind files;
  bool save = false;
};

// In the order of FilePurpose.
constexpr FileDialog kDialogs[] = {
    {"open", "open", "Open", "Open", FileKind::Known},
    {"open_source", "source.open", "Open source", "Open", FileKind::Source},
    {"", "source.motion", "Open source: now the motion of ", "Open", FileKind::BodyMotion},
    {"blend_with", "source.blend_with", "Blend with another motion", "Blend", FileKind::Source},
    {"map_folder", "map.index", "Read the motions of a folder onto the map", "Read", FileKind::Folder},
    {"source_times", "source.times", "Times of the scans", "Use", FileKind::Times},
    {"source_markers", "source.markers", "Markers of the scans", "Use", FileKind::Times},
    {"export_bones", "bones.export", "Export the found rig", "Export", FileKind::Any, true},
    {"second_body", "bones.perform", "A second body: a rig, a scan or scans", "Use", FileKind::Source},
    {"export_second_body", "bones.perform_export", "Export the second body's performance", "Export",
     FileKind::Any, true},
    {"open_target", "target.add", "Add target", "Add", FileKind::Target},
    {"replace_target", "target.replace", "Replace target", "Replace", FileKind::Target},
    {"load_proportions", "flat.load_proportions", "Load proportions", "Load", FileKind::Any},
    {"save_proportions", "flat.save_proportions", "Save proportions", "Save", FileKind::Any, true},
    {"style_file", "method.style", "Open a style", "Use", FileKind::Any},
    {"open_document", "document.open", "Open document", "Open", FileKind::Document},
    {"save_as", "document.save_as", "Save document", "Save", FileKind::Document, true},
    {"", "document.relocate", "Find ", "Use this file", FileKind::Any},
    {"open_study", "study.open", "Open study", "Open", FileKind::Study},
    {"save_study", "study.save_as", "Save study", "Save", FileKind::Study, true},
    {"study_files", "study.add_files", "Add a condition of an animation", "Add", FileKind::Source},
    {"study_animation", "study.add_file", "Add animation", "Add", FileKind::Source},
    {"study_motion", "study.add_motion", "Add motion", "Add", FileKind::Source},
    {"study_target", "study.add_target", "Add target", "Add", FileKind::Target},
    {"study_answers", "study.analyse", "Choose one of the answers", "Analyse", FileKind::Answers},
    {"study_table", "study.export table", "Export trials", "Export", FileKind::Any, true},
    {"study_csv", "study.export csv", "Export trials", "Export", FileKind::Any, true},
    {"study_jspsych", "study.export jspsych", "Export trials for jsPsych", "Export", FileKind::Any, true},
    {"study_psychopy", "study.export psychopy", "Export trials for PsychoPy", "Export", FileKind::Any, true},
    {"study_stimuli", "study.render", "Render stimuli into a folder", "Render", FileKind::Any, true},
    {"", "", "Choose the folder", "Use it", FileKind::Folder},
    {"", "", "2D poses of the reference", "Use", FileKind::Poses},
    {"", "", "Where to", "Choose", FileKind::Any, true}};

const FileDialog& dialog_of(FilePurpose purpose) {
  return kDialogs[static_cast<size_t>(purpose)];
}

/// "mine.study" or "mine trials.csv", beside the study.
std::string study_name(const app::Session& session, FilePurpose purpose) {
  const app::StudyState& state = session.study;
  if (purpose == FilePurpose::SaveStudy && !state.path.empty()) return state.path;
  const std::string title = state.study ? app::safe_file_name(state.study->name) : "";
  fs::path stem = state.path.empty() ? fs::path(title) : fs::path(state.path).replace_extension();
  if (purpose == FilePurpose::SaveStudy) return stem.string() + ".study";
  if (purpose == FilePurpose::Stimuli) return stem.string() + " stimuli";
  const auto format = static_cast<size_t>(purpose) - static_cast<size_t>(FilePurpose::TrialsTable);
  return stem.string() + " trials" + app::trial_formats()[format].suffix;
}

bool is_of_study(FilePurpose purpose) {
  return purpose == FilePurpose::SaveStudy || purpose >= FilePurpose::TrialsTable;
}

std::string document_name(const app::Session& session) {
  if (!session.path.empty()) return session.path;
  const std::string name =
      session.source.name.empty() ? "untitled" : fs::path(session.source.name).stem().string();
  return name + ".understudy";
}

std::string bones_name(const app::Session& session) {
  return fs::path(session.source.name).stem().string() + " rig.glb";
}

std::string second_body_name(const app::Session& session) {
  return fs::path(session.document.bones.second.path).stem().string() + " performs.glb";
}

std::string proportions_name(const app::Session& session) {
  const app::Take* const take = selected_take(session);
  return (take != nullptr ? app::safe_file_name(take->name) : "person") + " proportions.json";
}

/// The folder, or the next above it that is there.
std::string there_of(const std::string& folder) {
  std::error_code failed;
  fs::path path = folder;
  while (!path.empty() && !fs::is_directory(path, failed) && path != path.parent_path())
    path = path.parent_path();
  return path.string();
}

}  // namespace

std::string folder_of_choice(const std::string& path) {
  std::error_code failed;
  return fs::is_directory(path, failed) ? path : fs::path(path).parent_path().string();
}

std::optional<FilePurpose> purpose_of(const std::string& dialog) {
  for (const FileDialog& one : kDialogs)
    if (!dialog.empty() && dialog == one.name) return static_cast<FilePurpose>(&one - kDialogs);
  return std::nullopt;
}

const char* file_dialog_for(const std::string& command) {
  for (const FileDialog& one : kDialogs)
    if (command == one.command && *one.name != 0) return one.name;
  return nullptr;
}

void choose_file(const app::Session& session, FilesState& state, FilePurpose purpose,
                 const std::string& name) {
  const FileDialog& dialog = dialog_of(purpose);
  BrowseRequest request{dialog.title, dialog.accept, dialog.save, {filter_of(dialog.files)}, "", ""};
  state.purpose = purpose;
  if (purpose == FilePurpose::Folder) request.folder = there_of(name);
  if (purpose == FilePurpose::Relocate || purpose == FilePurpose::BodyMotion)
    state.first = name, request.title += file_name(name);
  if (dialog.save) {
    const std::string usual = purpose == FilePurpose::Export             ? ""
                              : is_of_study(purpose)                     ? study_name(session, purpose)
                              : purpose == FilePurpose::ExportBones      ? bones_name(session)
                              : purpose == FilePurpose::ExportSecondBody ? second_body_name(session)
                              : purpose == FilePurpose::SaveProportions  ? proportions_name(session)
                                                                         : document_name(session);
    const fs::path proposed = name.empty() ? usual : name;
    request.name = proposed.filename().string();
    request.folder = proposed.parent_path().string();
  } else if (dialog.files != FileKind::Any && dialog.files != FileKind::Folder) {
    request.filters.push_back(filter_of(FileKind::Any));
  }
  const bool first_time = state.browser.folder().empty();
  if (request.folder.empty() && first_time) request.folder = session.settings.last_folder;
  state.browser.open(std::move(request));
}

std::optional<std::string> draw_files(const app::Session& session, PanelContext& context, FilesState& state) {
  std::optional<std::string> path = state.browser.draw(context.ui);
  const bool comes_back = state.purpose == FilePurpose::Export || state.purpose == FilePurpose::Folder ||
                          state.purpose == FilePurpose::Reference;
  if (!path || comes_back) return path;
  if (state.purpose == FilePurpose::Source && is_smpl_body(*path)) {
    choose_file(session, state, FilePurpose::BodyMotion, *path);
    context.ui.focus().await_dialog();
    return std::nullopt;
  }
  app::Arguments arguments = {*path}, words = app::split_line(dialog_of(state.purpose).command);
  constexpr FilePurpose kOfTake[] = {FilePurpose::ReplaceTarget, FilePurpose::Style,
                                     FilePurpose::LoadProportions, FilePurpose::SaveProportions};
  if (std::find(std::begin(kOfTake), std::end(kOfTake), state.purpose) != std::end(kOfTake))
    arguments.insert(arguments.begin(), std::to_string(session.selected_take));
  if (state.purpose == FilePurpose::BodyMotion || state.purpose == FilePurpose::Relocate)
    arguments.insert(arguments.begin(), state.first);
  if (state.purpose == FilePurpose::StudyAnimation)
    arguments.insert(arguments.begin(),
                     std::to_string(app::chosen(session.study, app::StudyList::Condition)));
  arguments.insert(arguments.begin(), words.begin() + 1, words.end());
  context.ask(words.front(), arguments);
  using Kind = app::Question::Kind;
  const auto waits = [&](Kind kind) { return session.question && session.question->kind == kind; };
  if ((state.purpose == FilePurpose::SaveDocument && waits(Kind::UnsavedChanges)) ||
      (state.purpose == FilePurpose::SaveStudy && waits(Kind::UnsavedStudy)))
    context.ask("question.answer", {"save"});
  return std::nullopt;
}

}  // namespace understudy::ui
