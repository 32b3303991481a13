#include "ui/panels/files.hpp"

#include <filesystem>

namespace understudy::ui {
namespace fs = std::filesystem;
namespace {

BrowseRequest request_for(FilePurpose purpose) {
  switch (purpose) {
    case FilePurpose::Scan:
      return {"Open scan", "Open", false, {scan_filter(), any_filter()}, "", ""};
    case FilePurpose::MotionBody:
      return {"Open motion: first the body", "Next", false, {body_filter(), any_filter()}, "", ""};
    case FilePurpose::Motion:
      return {"Open motion: now the motion", "Open", false, {motion_filter(), any_filter()}, "", ""};
    case FilePurpose::Target:
      return {"Add target", "Add", false, {target_filter(), any_filter()}, "", ""};
    case FilePurpose::ReplaceTarget:
      return {"Replace target", "Replace", false, {target_filter(), any_filter()}, "", ""};
    case FilePurpose::Document:
      return {"Open document", "Open", false, {document_filter(), any_filter()}, "", ""};
    case FilePurpose::SaveDocument:
      return {"Save document", "Save", true, {document_filter()}, "", ""};
    case FilePurpose::Relocate:
      return {"Find a missing file", "Use this file", false, {any_filter()}, "", ""};
    case FilePurpose::Export:
      return {"Where to", "Choose", true, {{"All files", {}, false}}, "", ""};
    default:
      return {"Open", "Open", false, {known_filter(), any_filter()}, "", ""};
  }
}

std::string document_name(const app::Session& session) {
  if (!session.path.empty()) return session.path;
  const std::string name =
      session.source.name.empty() ? "untitled" : fs::path(session.source.name).stem().string();
  return name + ".understudy";
}

void ask_to_save(const app::Session& session, PanelContext& context, const std::string& path) {
  context.ask("document.save_as", {path});
  const bool waits = session.question && session.question->kind == app::Question::Kind::UnsavedChanges;
  if (waits) context.ask("question.answer", {"save"});
}

}  // namespace

void choose_file(const app::Session& session, FilesState& state, FilePurpose purpose,
                 const std::string& name) {
  BrowseRequest request = request_for(purpose);
  state.purpose = purpose;
  if (purpose == FilePurpose::Relocate) state.first = name;
  if (request.save) {
    const fs::path proposed = name.empty() ? fs::path(document_name(session)) : fs::path(name);
    request.name = proposed.filename().string();
    request.folder = proposed.has_parent_path() ? proposed.parent_path().string() : "";
  }
  if (purpose == FilePurpose::Relocate) request.title = "Find " + file_name(name);
  const bool first_time = state.browser.folder().empty();
  if (request.folder.empty() && first_time) request.folder = session.settings.last_folder;
  state.browser.open(std::move(request));
}

std::optional<std::string> draw_files(const app::Session& session, PanelContext& context, FilesState& state) {
  const std::optional<std::string> path = state.browser.draw(context.ui);
  if (!path) return std::nullopt;
  switch (state.purpose) {
    case FilePurpose::Scan:
      context.ask("source.open", {*path});
      break;
    case FilePurpose::MotionBody:
      state.first = *path;
      choose_file(session, state, FilePurpose::Motion);
      break;
    case FilePurpose::Motion:
      context.ask("source.motion", {state.first, *path});
      break;
    case FilePurpose::Target:
      context.ask("target.add", {*path});
      break;
    case FilePurpose::ReplaceTarget:
      context.ask("target.replace", {std::to_string(session.selected_take), *path});
      break;
    case FilePurpose::Document:
      context.ask("document.open", {*path});
      break;
    case FilePurpose::SaveDocument:
      ask_to_save(session, context, *path);
      break;
    case FilePurpose::Relocate:
      context.ask("document.relocate", {state.first, *path});
      break;
    case FilePurpose::Export:
      return path;
    default:
      context.ask("open", {*path});
  }
  return std::nullopt;
}

}  // namespace understudy::ui
