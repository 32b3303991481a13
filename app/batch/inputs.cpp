#include "app/batch/inputs.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// What follows the first word of each line that begins with `first`; an empty one: all of each line.
void add_named(const std::string& path, const std::string& first, std::vector<std::string>& out) {
  const std::string text = read_file(path);
  TextCursor cursor(text, path);
  std::vector<std::string_view> words;
  while (!cursor.at_end()) {
    const std::string_view line = trim_end(cursor.line());
    split_words(line, "", words);
    if (words.empty()) continue;
    const size_t from = first.empty() ? 0 : 1;
    if (words.size() > from && starts_with(words[0], first))
      out.emplace_back(line.substr(static_cast<size_t>(words[from].data() - line.data())));
  }
}

void add_gltf_uris(const std::string& path, std::vector<std::string>& out) {
  const Json json = Json::parse(read_file(path), nullptr, /*allow_exceptions=*/false);
  for (const char* list : {"buffers", "images"}) {
    if (!json.is_object() || !json.contains(list) || !json[list].is_array()) continue;
    for (const Json& one : json[list])
      if (one.is_object() && one.contains("uri") && one["uri"].is_string())
        out.push_back(one["uri"].get<std::string>());
  }
}

/// What a file names, as it names it: not all of it need be there.
std::vector<std::string> named_in(const std::string& path) {
  std::vector<std::string> names;
  const std::string suffix = file_suffix(path);
  if (suffix == ".gltf") add_gltf_uris(path, names);
  if (suffix == ".obj") add_named(path, "mtllib", names);
  if (suffix == ".mtl") add_named(path, "map_", names);
  if (suffix == ".lst" || suffix == ".txt") add_named(path, "", names);
  return names;
}

/// The file, then those that it names and that are there, each once.
void add_with_named(const std::string& path, std::vector<std::string>& files) {
  if (std::find(files.begin(), files.end(), path) != files.end()) return;
  files.push_back(path);
  std::error_code failed;
  for (const std::string& name : named_in(path)) {
    if (name.find('\0') != std::string::npos) continue;
    const fs::path there = fs::path(path).parent_path() / name;
    if (fs::is_regular_file(there, failed)) add_with_named(there.lexically_normal().string(), files);
  }
}

void hash_text(const std::string& text, uint64_t& hash) {
  hash = fnv1a(text, hash);
  hash = fnv1a(std::string_view("\0", 1), hash);  // names are told from what follows
}

void add_content(const std::string& path, uint64_t& hash) {
  check_file(path);
  std::ifstream in(path, std::ios::binary);
  std::string block(size_t{1} << 20, '\0');
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash = fnv1a(std::string_view(block.data(), static_cast<size_t>(in.gcount())), hash);
  }
  US_CHECK(in.eof(), path, ": cannot be read");
}

}  // namespace

std::vector<std::string> files_of(const std::string& path) {
  std::vector<std::string> files;
  std::error_code failed;
  if (!fs::is_directory(path, failed)) {
    check_file(path);
    add_with_named(path, files);
    return files;
  }
  for (fs::directory_iterator entry(path, failed), end; !failed && entry != end; entry.increment(failed))
    if (entry->path().filename().string().front() != '.' && entry->is_regular_file(failed))
      files.push_back(entry->path().string());
  US_CHECK(!failed, path, ": cannot be read (", failed.message(), ")");
  std::sort(files.begin(), files.end());
  return files;
}

std::string stamp_of(const std::vector<std::string>& files) {
  uint64_t hash = kFnvStart;
  for (const std::string& path : files) {
    struct stat about {};
    US_CHECK(::stat(path.c_str(), &about) == 0, path, ": cannot be read");
    hash_text(file_name(path), hash);
    hash_text(printed("%lld %lld.%09ld", static_cast<long long>(about.st_size),
                      static_cast<long long>(about.st_mtim.tv_sec), about.st_mtim.tv_nsec),
              hash);
  }
  return checksum_text(hash);
}

std::string hash_of(const std::vector<std::string>& files) {
  uint64_t hash = kFnvStart;
  for (const std::string& path : files) {
    hash_text(file_name(path), hash);
    hash_text(std::to_string(check_file(path)), hash);
    add_content(path, hash);
  }
  return checksum_text(hash);
}

InputRecord record_input(const std::string& path) {
  InputRecord record;
  record.path = path;
  const std::vector<std::string> files = files_of(path);
  record.stamp = stamp_of(files);  // before the content: what is written meanwhile has another one
  record.hash = hash_of(files);
  record.files = static_cast<int64_t>(files.size());
  for (const std::string& file : files) record.bytes += static_cast<int64_t>(check_file(file));
  return record;
}

bool is_as_recorded(const InputRecord& record) {
  const std::vector<std::string> files = files_of(record.path);
  return static_cast<int64_t>(files.size()) == record.files &&
         (stamp_of(files) == record.stamp || hash_of(files) == record.hash);
}

Json to_json(const InputRecord& record) {
  return {{"path", record.path},
          {"files", record.files},
          {"bytes", record.bytes},
          {"hash", record.hash},
          {"stamp", record.stamp}};
}

InputRecord input_record(const Json& json) {
  return {json.at("path").get<std::string>(), json.at("files").get<int64_t>(),
          json.at("bytes").get<int64_t>(), json.at("hash").get<std::string>(),
          json.at("stamp").get<std::string>()};
}

}  // namespace understudy::app
