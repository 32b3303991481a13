#include "app/session/document_file.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int64_t kLargestDocument = int64_t{1} << 30;

/// Objects a member a line, lists of numbers in one line: readable, and without a line for each weight.
void print(const Json& json, size_t depth, std::string& out) {
  const bool object = json.is_object();
  const auto structured = [](const Json& one) { return one.is_object(); };
  if (json.empty() || (!object && !(json.is_array() && std::any_of(json.begin(), json.end(), structured)))) {
    out += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  out += object ? '{' : '[';
  bool first = true;
  for (const auto& item : json.items()) {
    out += first ? "\n" : ",\n";
    first = false;
    out.append(depth + 1, ' ');
    if (object) out += Json(item.key()).dump() + ": ";
    print(item.value(), depth + 1, out);
  }
  out += '\n';
  out.append(depth, ' ');
  out += object ? '}' : ']';
}

std::string folder_of(const std::string& path) {
  US_CHECK(!path.empty(), "a document without a name can be neither read nor written");
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  US_CHECK(!error, path, ": cannot be found (", error.message(), ")");
  return whole.parent_path().string();
}

/// Removes empty parts and ".": "a/b/" and "a/./b" are one place.
fs::path place(const std::string& path) {
  fs::path normal = fs::path(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

template <class Document, class Visit>
void visit_paths(Document& document, Visit visit) {
  visit(document.source.path);
  visit(document.source.motion);
  visit(document.truth);
  for (auto& take : document.takes) visit(take.target.path);
}

}  // namespace

std::string document_text(const nlohmann::ordered_json& json) {
  std::string text;
  print(json, 0, text);
  return text + '\n';
}

nlohmann::ordered_json parse_document(const std::string& text, const std::string& path) {
  US_CHECK(!text.empty(), path, ": is empty");
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(path + ": is damaged at byte " + std::to_string(error.byte));
  } catch (const nlohmann::json::exception&) {
    throw Error(path + ": holds something that is not a number");
  }
}

nlohmann::ordered_json read_document_json(const std::string& path) {
  return parse_document(read_file(path, kLargestDocument), path);
}

void write_document(const std::string& path, const SavedDocument& saved) {
  write_file(path, document_text(to_json(saved, folder_of(path))));
}

SavedDocument read_document(const std::string& path) {
  const std::string folder = folder_of(path);
  return from_json(read_document_json(path), folder, path);
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
