#include "app/session/document_file.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// Removes empty parts and ".": "a/b/" and "a/./b" are one place.
fs::path place(const std::string& path) {
  fs::path normal = fs::path(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

template <class Document, class Visit>
void visit_paths(Document& document, Visit visit) {
  visit(document.source.path);
  visit(document.source.motion);
  visit(document.source.times);
  visit(document.source.markers);
  visit(document.truth);
  visit(document.bones.second.path);
  if (document.source.blend)
    for (auto& part : document.source.blend->parts) visit(part.path);
  for (auto& take : document.takes) visit(take.target.path), visit(take.method.style.file);
}

}  // namespace

void write_document(const std::string& path, const SavedDocument& saved) {
  write_file(path, json_text(to_json(saved, folder_of_file(path))));
}

SavedDocument read_document(const std::string& path) {
  const std::string folder = folder_of_file(path);
  return from_json(read_json(path), folder, path);
}

std::vector<std::string> missing_files(const Document& document) {
  std::vector<std::string> missing;
  visit_paths(document, [&](const std::string& path) {
    std::error_code ignored;
    if (path.empty() || fs::exists(path, ignored)) return;
    if (std::find(missing.begin(), missing.end(), path) == missing.end()) missing.push_back(path);
  });
  return missing;
}

Document relocated(Document document, const std::string& from, const std::string& to) {
  US_CHECK(!from.empty() && !to.empty(), "a place to move from or to is missing");
  const fs::path old_place = place(from), new_place = place(to);
  visit_paths(document, [&](std::string& path) {
    if (path.empty()) return;
    const fs::path now = place(path);
    const auto [rest, below] = std::mismatch(now.begin(), now.end(), old_place.begin(), old_place.end());
    if (below != old_place.end()) return;
    fs::path moved = new_place;
    for (auto part = rest; part != now.end(); ++part) moved /= *part;
    path = moved.string();
  });
  return document;
}

}  // namespace understudy::app
