// Documents on disk: .understudy, one JSON file with paths relative to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/fields_json.hpp"
#include "app/session/document.hpp"
#include "app/session/playback.hpp"
#include "app/session/view.hpp"
#include "retarget/base/fields.hpp"

namespace understudy::app {

constexpr int kDocumentVersion = 1;

/// The contents of the file.
struct SavedDocument {
  Document document;
  View view;
  Playback playback;
  std::string weights;                 ///< the networks' checksums when it was saved
  std::optional<int> selected_take{};  ///< the current take; none in older files: that of the active view
};
template <class V, class S>
FieldsOf<S, SavedDocument> fields(V& visit, S& saved) {
  visit("weights", saved.weights);
  fields(visit, saved.document);
  visit("view", saved.view);
  visit("playback", saved.playback);
  visit("selected_take", saved.selected_take, kFrameNumbers);
}

Json to_json(const SavedDocument& saved, const std::string& folder);
/// Throws Error naming `path` and the member that is wrong.
SavedDocument from_json(const Json& json, const std::string& folder, const std::string& path);

/// Writes beside the file, then renames: when the disk is full the old document survives. Throws Error naming
/// the path.
void write_document(const std::string& path, const SavedDocument& saved);
/// Throws Error when the file is missing, no document, damaged or from a newer version.
SavedDocument read_document(const std::string& path);

/// Files and folders that the document names and that are missing.
std::vector<std::string> missing_files(const Document& document);
/// The document with `from`, and every path under it, replaced by `to`.
Document relocated(Document document, const std::string& from, const std::string& to);

/// A copy of unsaved work, for after a crash.
struct Autosave {
  std::string file;           ///< of the copy
  std::string document_path;  ///< where the document was saved; empty: never
  std::string time;           ///< local, "2024-05-01 14:03"
};
/// Writes the copy of this process into `folder` (beside the file, then renames). Throws Error.
void write_autosave(const std::string& folder, const SavedDocument& saved, const std::string& document_path);
/// Removes the copy of this process.
void remove_autosave(const std::string& folder);
/// Copies left by processes that no longer run. Renames damaged ones to .damaged, with a warning.
std::vector<Autosave> found_autosaves(const std::string& folder);
/// The document in a copy. Throws Error.
SavedDocument read_autosave(const Autosave& autosave);
void discard(const Autosave& autosave);

}  // namespace understudy::app
