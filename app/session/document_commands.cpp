#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "app/run/case_folder.hpp"
#include "app/run/flat_performance.hpp"
#include "app/session/background.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/motion/read_motion.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// What can be done at once when nothing is unsaved; else the question comes first. True: go on.
bool nothing_unsaved(Studio& studio, const std::string& then) {
  Session& session = studio.session();
  if (!session.changed) return true;
  const std::string name = session.path.empty() ? "this document" : file_name(session.path);
  session.question = Question{Question::Kind::UnsavedChanges, "Save the changes to " + name + "?", then};
  return false;
}

/// A document whose files are not all there asks for their new place; the rest opens.
void ask_for_missing(Session& session) {
  const std::vector<std::string> missing = missing_files(session.document);
  if (missing.empty()) return;
  const char* const text = missing.size() == 1 ? "A file of this document is missing."
                                               : "Some files of this document are missing.";
  session.question = Question{Question::Kind::MissingFiles, text, "", missing};
}

void open_document(Studio& studio, const std::string& path) {
  const std::string whole = fs::absolute(path).lexically_normal().string();
  auto& recent = studio.session().settings.recent;
  const SavedDocument saved = opened({&recent}, whole, [&] { return read_document(whole); });
  studio.replace_document(saved, whole);
  remember(recent, whole);
  remember_folder(studio, whole);
  if (!saved.weights.empty() && !studio.session().weights.empty() &&
      saved.weights != studio.session().weights)
    studio.notify("This document was made with other network weights: its result may differ.", true);
}

void save_document(Studio& studio, const std::string& path) {
  Session& session = studio.session();
  const std::string whole = fs::absolute(path).lexically_normal().string();
  write_document(whole, studio.saved_document());
  session.path = whole;
  session.changed = false;
  remember(session.settings.recent, whole);
  remember_folder(studio, whole);
  studio.end_autosave();
  studio.notify("Saved " + file_name(whole));
}

void answer(Call& c) {
  const std::string& how = c.one_of(0, "answer", {"save", "discard", "cancel"});
  Session& session = c.session;
  US_CHECK(session.question, "there is no question to answer");
  const Question question = *session.question;
  const bool is_of_study = question.kind == Question::Kind::UnsavedStudy;
  if (how == "save") {
    const std::string& path = is_of_study ? session.study.path : session.path;
    US_CHECK(!path.empty(), is_of_study ? "the study" : "the document",
             " has no file yet: save it under a name first");
    is_of_study ? save_study(c.studio, path) : save_document(c.studio, path);
  }
  session.question.reset();
  const bool is_refused = question.kind == Question::Kind::NotAPerson ||
                          (question.kind == Question::Kind::Canvas && question.take >= 0 && how == "cancel");
  if (is_refused && question.take < ssize(session.takes)) c.studio.take_back_target(question.take);
  if (how == "cancel" || (question.kind != Question::Kind::UnsavedChanges && !is_of_study)) return;
  (is_of_study ? session.study.changed : session.changed) = false;
  const Arguments words = split_line(question.then);
  c.studio.run(words.front(), {words.begin() + 1, words.end()});
}

/// Several things at once: one that cannot be opened does not keep the others out. What fails is tried again
/// after the rest: a motion may be named before the body that performs it.
void open_all(Call& c) {
  if (c.arguments.size() < 2) return c.studio.open(c.word(0, "path"));
  Arguments later;
  for (const std::string& path : c.arguments) {
    try {
      c.studio.open(path);
    } catch (const Error&) {
      later.push_back(path);
    }
  }
  for (const std::string& path : later) c.studio.try_run("open", {path});
}

void add_files(Commands& commands) {
  commands.add({"document.new", "New", "", "Ctrl+N"}, [](Call& c) {
    if (nothing_unsaved(c.studio, "document.new")) c.studio.replace_document({}, "");
  });
  commands.add({"document.open", "Open document", "PATH"}, [](Call& c) {
    const std::string& path = c.word(0, "path");
    if (nothing_unsaved(c.studio, join_line("document.open", {path}))) open_document(c.studio, path);
  });
  commands.add({"document.save", "Save", "", "Ctrl+S"}, [](Call& c) {
    US_CHECK(!c.session.path.empty(), "the document has no file yet: save it under a name");
    save_document(c.studio, c.session.path);
  });
  commands.add({"document.save_as", "Save as", "PATH"}, [](Call& c) {
    const std::string& path = c.word(0, "path");
    save_document(c.studio, can_be(path, kDocument) ? path : path + ".understudy");
  });
  commands.add({"open", "Open", "PATH ...: a scan, target, 2D poses, document, study or case"}, open_all);
}

void recover(Call& c) {
  const std::string& file = c.word(0, "file");
  for (const Autosave& found : found_autosaves(c.studio.services().autosave_folder)) {
    if (found.file != file) continue;
    const SavedDocument saved = read_autosave(found);
    c.session.question.reset();
    c.studio.replace_document(saved, found.document_path);
    c.session.changed = true;
    discard(found);
    return;
  }
  throw Error(file + ": there is no such unsaved work");
}

void discard_recovery(Call& c) {
  const std::string& file = c.word(0, "file");
  const auto is_it = [&](const Autosave& copy) { return copy.file == file; };
  for (const Autosave& found : found_autosaves(c.studio.services().autosave_folder))
    if (is_it(found)) discard(found);
  auto& question = c.session.question;
  if (!question) return;
  auto& left = question->autosaves;
  left.erase(std::remove_if(left.begin(), left.end(), is_it), left.end());
  if (left.empty()) question.reset();
}

void add_recovery(Commands& commands) {
  commands.add({"question.answer", "Answer", "save|discard|cancel"}, answer);
  commands.add({"document.recover", "Recover", "FILE"}, recover);
  commands.add({"document.discard_recovery", "Discard", "FILE"}, discard_recovery);
  commands.add_edit({"document.relocate", "Find the file", "OLD NEW: where it is now"}, [](Call& c) {
    c.document = relocated(c.document, c.word(0, "old place"), c.word(1, "new place"));
    c.session.question.reset();
    ask_for_missing(c.session);
  });
}

constexpr uint64_t kGlance = 1 << 20;  // bytes of a glTF that may be read before the UI thread draws on

/// Gltf: a motion or a mesh; which of them, only more than a glance shows.
enum class Kind { Document, Study, Case, Scans, Body, Motion, Mesh, Gltf, Flat };

Kind kind_of_npz(const std::string& path) {
  const std::vector<std::string> names = npz_names(path);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return has("v_template") ? Kind::Body : has("poses") ? Kind::Motion : Kind::Scans;
}

/// Whether a file that may be a character or a motion is opened as the motion: with a target and no source.
bool wants_motion(const Document& document) {
  return document.source.path.empty() && !document.takes.empty();
}

Kind kind_of(const Document& document, const std::string& path) {
  std::error_code failed;
  US_CHECK(fs::exists(path, failed), path, ": there is no such file or folder");
  if (fs::is_directory(path, failed))
    return fs::exists(fs::path(path) / "case.json") ? Kind::Case
           : looks_like_keypoints(path)             ? Kind::Flat
                                                    : Kind::Scans;
  if (can_be(path, kDocument)) return Kind::Document;
  if (flat_target_file(path)) return Kind::Flat;
  if (can_be(path, kStudy)) return Kind::Study;
  if (fs::path(path).filename() == "case.json") return Kind::Case;
  if (can_be(path, kBody)) return kind_of_npz(path);
  if (format_of_file(path, kTarget) == nullptr) {
    US_CHECK(can_be(path, kMotion | kScanSequence), path,
             ": is neither a scan, a target, a motion, 2D poses, a document nor a study");
    return Kind::Scans;
  }
  if (!wants_motion(document)) return Kind::Mesh;
  if (is_motion_file(path)) return Kind::Scans;
  const std::optional<bool> animated = is_animated_gltf(path, kGlance);
  return !animated ? Kind::Gltf : *animated ? Kind::Scans : Kind::Mesh;
}

/// Reads a large glTF on a worker, then opens it as what it is.
void open_large_gltf(Studio& studio, const std::string& path) {
  const auto animated = std::make_shared<bool>();
  studio.jobs().start(
      "Reading " + file_name(path),
      [animated, path](JobControl&) {
        *animated = is_animated_gltf(path, std::numeric_limits<uint64_t>::max()).value_or(false);
      },
      [&studio, animated, path] {
        const bool motion = *animated && wants_motion(studio.session().document);
        studio.run(motion ? "source.open" : "target.add", {path});
      });
}

void open_case(Studio& studio, std::string folder) {
  if (!fs::is_directory(folder)) folder = fs::path(folder).parent_path().string();
  const Case found = read_case(folder);
  SavedDocument fresh;
  fresh.document.source.path = found.source;
  fresh.document.source.fps = found.fps;
  fresh.document.truth = found.truth;
  if (!found.target.empty()) {
    Take take;
    take.name = found.name;
    take.target.path = found.target;
    take.target.forward = false;  // a case's target stands as its truth does
    fresh.document.takes.push_back(take);
  }
  studio.replace_document(fresh, "");
}

}  // namespace

void Studio::replace_document(SavedDocument saved, const std::string& path) {
  session_.failures.clear();
  session_.said_before = session_.time;
  session_.selected_take = 0;
  session_.document = std::move(saved.document);
  session_.view = std::move(saved.view);
  if (session_.view.cameras.empty()) session_.view.cameras.push_back({});
  session_.playback = saved.playback;
  session_.playback.playing = false;
  session_.playback.live = true;
  session_.path = path;
  session_.changed = false;
  session_.history.clear();
  choose_pane(session_, session_.view.active_pane);
  if (saved.selected_take) session_.selected_take = *saved.selected_take;
  background_->followed_take = -1;
  background_->opened_targets.clear();
  background_->opened_source.reset();
  background_->bones_key.clear();
  background_->second_work.reset();
  forget_incomplete_bones();
  session_.selected_joint = -1;
  session_.tool = Tool::Look;
  ask_for_missing(session_);
  follow_document();
}

void Studio::open(const std::string& path) {
  const std::string whole = fs::absolute(path).lexically_normal().string();
  Settings& settings = session_.settings;
  const auto lists = {&settings.recent, &settings.recent_sources, &settings.recent_targets,
                      &settings.recent_studies};
  switch (opened(lists, whole, [&] { return kind_of(session_.document, whole); })) {
    case Kind::Document:
      return run("document.open", {whole});
    case Kind::Study:
      return run("study.open", {whole});
    case Kind::Case:
      if (nothing_unsaved(*this, join_line("open", {whole}))) open_case(*this, whole);
      return;
    case Kind::Scans:
      return run("source.open", {whole});
    case Kind::Motion:
      // A body that is there performs it; without one its skeleton is the source.
      if (session_.document.takes.empty() || !can_be(session_.document.takes.back().target.path, kBody))
        return run("source.open", {whole});
      return run("source.motion", {session_.document.takes.back().target.path, whole});
    case Kind::Body:
    case Kind::Mesh:
      return run("target.add", {whole});
    case Kind::Gltf:
      return open_large_gltf(*this, whole);
    case Kind::Flat:
      return run(session_.document.flat || flat_target_file(whole) != whole || is_proportions_file(whole)
                     ? "target.add"
                     : "source.open",
                 {whole});
  }
}

void add_document_commands(Commands& commands) {
  add_files(commands);
  add_recovery(commands);
}

}  // namespace understudy::app
