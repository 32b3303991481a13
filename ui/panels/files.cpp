#include "ui/panels/files.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"

namespace understudy::ui {
namespace fs = std::filesystem;
namespace {

struct FileDialog {
  const char* name;     ///< for dialog.open; empty: only the window opens it
  const char* command;  ///< gets the path as its last argument
  const char *title, *accept;
  FileKind files;
  bool save = false;
};

// In the order of FilePurpose.
constexpr FileDialog kDialogs[] = {
    {"open", "open", "Open", "Open", FileKind::Known},
    {"open_source", "source.open", "Open source", "Open", FileKind::Source},
    {"", "source.motion", "Open source: now the motion of ", "Open", FileKind::BodyMotion},
    {"open_target", "target.add", "Add target", "Add", FileKind::Target},
    {"replace_target", "target.replace", "Replace target", "Replace", FileKind::Target},
    {"open_document", "document.open", "Open document", "Open", FileKind::Document},
    {"save_as", "document.save_as", "Save document", "Save", FileKind::Document, true},
    {"", "document.relocate", "Find ", "Use this file", FileKind::Any},
    {"", "", "Where to", "Choose", FileKind::Any, true}};

const FileDialog& dialog_of(FilePurpose purpose) {
  return kDialogs[static_cast<size_t>(purpose)];
}

std::string document_name(const app::Session& session) {
  if (!session.path.empty()) return session.path;
  const std::string name =
      session.source.name.empty() ? "untitled" : fs::path(session.source.name).stem().string();
  return name + ".understudy";
}

}  // namespace

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
  if (purpose == FilePurpose::Relocate || purpose == FilePurpose::BodyMotion)
    state.first = name, request.title += file_name(name);
  if (dialog.save) {
    const fs::path proposed = name.empty() ? fs::path(document_name(session)) : fs::path(name);
    request.name = proposed.filename().string();
    request.folder = proposed.parent_path().string();
  } else if (dialog.files != FileKind::Any) {
    request.filters.push_back(filter_of(FileKind::Any));
  }
  const bool first_time = state.browser.folder().empty();
  if (request.folder.empty() && first_time) request.folder = session.settings.last_folder;
  state.browser.open(std::move(request));
}

std::optional<std::string> draw_files(const app::Session& session, PanelContext& context, FilesState& state) {
  std::optional<std::string> path = state.browser.draw(context.ui);
  if (!path || state.purpose == FilePurpose::Export) return path;
  if (state.purpose == FilePurpose::Source && is_smpl_body(*path)) {
    choose_file(session, state, FilePurpose::BodyMotion, *path);
    context.ui.focus().await_dialog();
    return std::nullopt;
  }
  app::Arguments arguments = {*path};
  if (state.purpose == FilePurpose::ReplaceTarget)
    arguments.insert(arguments.begin(), std::to_string(session.selected_take));
  if (state.purpose == FilePurpose::BodyMotion || state.purpose == FilePurpose::Relocate)
    arguments.insert(arguments.begin(), state.first);
  context.ask(dialog_of(state.purpose).command, arguments);
  const bool waits = session.question && session.question->kind == app::Question::Kind::UnsavedChanges;
  if (state.purpose == FilePurpose::SaveDocument && waits) context.ask("question.answer", {"save"});
  return std::nullopt;
}

}  // namespace understudy::ui
