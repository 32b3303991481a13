#include "app/batch/manifest.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <unordered_map>

#include "app/run/fields_json.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr uint64_t kLargestManifest = uint64_t{1} << 30;
constexpr size_t kLongestId = 200;  // with what records and part files add to it, a file's name
constexpr const char *kDone = ".done.json", *kFailed = ".failed.json";

/// How many letters must be put in, taken out or exchanged to make one word of the other.
size_t distance_between(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t exchanged = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({exchanged, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// "'sorce' is not known; the nearest is 'source'"; none is near of which half the letters are others.
std::string unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  std::string sentence = what + "'" + excerpt(name) + "' is not known", nearest;
  size_t least = std::min<size_t>(64, name.size() / 2 + 1);
  for (const std::string& one : known)
    if (const size_t off = name.size() > 64 ? least : distance_between(name, one); off < least)
      least = off, nearest = one;
  return nearest.empty() ? sentence : sentence + "; the nearest that is: '" + nearest + "'";
}

/// Reads one line.
class LineReader {
 public:
  LineReader(const std::string& where, const std::vector<BatchCommand>& commands)
      : where_(where), commands_(commands) {}

  BatchJob read(const std::string& text);

 private:
  const BatchCommand& command_of(const Json& json) const;
  std::string text_of(const Json& value, const std::string& name) const;
  std::vector<std::string> texts_of(const Json& json, const char* name) const;
  void check_work(const BatchJob& job, const BatchCommand& command) const;
  Json options_of(const Json& options, const BatchCommand& command) const;
  void check_value(const Json& value, const std::string& name, const BatchOption& option) const;

  const std::string& where_;  // "jobs.jsonl line 3: "
  const std::vector<BatchCommand>& commands_;
};

BatchJob LineReader::read(const std::string& text) {
  const Json json = parse_json(text, where_.substr(0, where_.size() - 2));
  US_CHECK(json.is_object(), where_, "is no object: {\"id\": ..., \"source\": ..., \"target\": ...}");
  static const std::vector<std::string> kKeys = {"id", "do", "source", "target", "document", "options"};
  for (const auto& item : json.items())
    US_CHECK(std::find(kKeys.begin(), kKeys.end(), item.key()) != kKeys.end(), where_,
             unknown("", item.key(), kKeys));
  US_CHECK(json.contains("id"), where_, "has no id");
  BatchJob job;
  job.id = text_of(json["id"], "id");
  US_CHECK(is_plain_name(job.id) && job.id.size() <= kLongestId && !ends_with(job.id, kDone) &&
               !ends_with(job.id, kFailed),
           where_, "the id '", excerpt(job.id),
           "' cannot name a file: letters, digits, points, - and _ alone, no folder, up to ", kLongestId,
           " characters");
  const BatchCommand& command = command_of(json);
  job.command = command.name;
  job.sources = texts_of(json, "source");
  job.targets = texts_of(json, "target");
  if (json.contains("document")) job.document = text_of(json["document"], "document");
  check_work(job, command);
  if (json.contains("options")) job.options = options_of(json["options"], command);
  return job;
}

const BatchCommand& LineReader::command_of(const Json& json) const {
  const std::string name = json.contains("do") ? text_of(json["do"], "do") : commands_.front().name;
  std::vector<std::string> known;
  for (const BatchCommand& command : commands_) {
    if (command.name == name) return command;
    known.push_back(command.name);
  }
  throw Error(where_ + unknown("do: ", name, known));
}

std::string LineReader::text_of(const Json& value, const std::string& name) const {
  US_CHECK(value.is_string(), where_, name, " must be text");
  std::string text = value.get<std::string>();
  US_CHECK(!text.empty() && text.find('\0') == std::string::npos, where_, name, " is empty or no text");
  return text;
}

std::vector<std::string> LineReader::texts_of(const Json& json, const char* name) const {
  std::vector<std::string> texts;
  if (!json.contains(name)) return texts;
  const Json& value = json[name];
  if (!value.is_array()) return {text_of(value, name)};
  for (const Json& one : value) texts.push_back(text_of(one, name));
  US_CHECK(!texts.empty(), where_, name, " is an empty list");
  return texts;
}

void LineReader::check_work(const BatchJob& job, const BatchCommand& command) const {
  if (!job.document.empty()) {
    US_CHECK(command.takes_many, where_, command.name, " takes no document");
    US_CHECK(job.sources.empty() && job.targets.empty(), where_, "a document has its own source and target");
    return;
  }
  US_CHECK(!job.sources.empty(), where_, "has no source");
  US_CHECK(!job.targets.empty(), where_, "has no target");
  US_CHECK(command.takes_many || (job.sources.size() == 1 && job.targets.size() == 1), where_, command.name,
           " takes one source and one target");
}

Json LineReader::options_of(const Json& options, const BatchCommand& command) const {
  US_CHECK(options.is_object(), where_, "options must be an object: {\"fps\": 25}");
  std::map<std::string, Json> sorted;
  for (const auto& item : options.items()) {
    const auto found = command.options.find(item.key());
    if (found == command.options.end()) {
      std::vector<std::string> known;
      for (const auto& [name, option] : command.options) known.push_back(name);
      throw Error(where_ + unknown(command.name + " option ", item.key(), known));
    }
    check_value(item.value(), item.key(), found->second);
    sorted[item.key()] = item.value();
  }
  Json out = Json::object();
  for (const auto& [name, value] : sorted) out[name] = value;
  return out;
}

void LineReader::check_value(const Json& value, const std::string& name, const BatchOption& option) const {
  if (option.is_flag) {
    US_CHECK(value.is_boolean(), where_, "option ", name, " must be true or false");
    return;
  }
  const bool is_list = value.is_array() && !value.empty();
  const auto check_one = [&](const Json& one) {
    US_CHECK(one.is_number() || one.is_string(), where_, "option ", name,
             " must be a text, a number or a list of them");
    if (one.is_string()) text_of(one, "option " + name);
  };
  if (is_list)
    for (const Json& one : value) check_one(one);
  else
    check_one(value);
  if (option.path == BatchOption::Path::None) return;
  US_CHECK(value.is_string(), where_, "option ", name, " must be text");
  US_CHECK(option.path != BatchOption::Path::Written || is_plain_name(value.get<std::string>()), where_,
           "option ", name, ": '", excerpt(value.get<std::string>()),
           "' is no plain name; a job's files are written into a folder of its own");
}

}  // namespace

bool is_plain_name(const std::string& name) {
  if (name.empty() || name.front() == '.' || name.front() == '-') return false;
  return std::none_of(name.begin(), name.end(), [](char c) {
    return c == '/' || c == '\\' || (static_cast<unsigned char>(c) < 0x20) || c == 0x7f;
  });
}

std::vector<BatchJob> parse_manifest(const std::string& text, const std::string& path,
                                     const std::vector<BatchCommand>& commands) {
  std::vector<BatchJob> jobs;
  std::unordered_map<std::string, int> lines;  // by id
  TextCursor cursor(text, path);
  for (int line = 1; !cursor.at_end(); ++line) {
    const std::string one(trim_end(cursor.line()));
    if (one.find_first_not_of(" \t") == std::string::npos) continue;
    const std::string where = path + " line " + std::to_string(line) + ": ";
    jobs.push_back(LineReader(where, commands).read(one));
    jobs.back().line = line;
    const auto [first, fresh] = lines.emplace(jobs.back().id, line);
    US_CHECK(fresh, where, "the id '", excerpt(jobs.back().id), "' is that of line ", first->second);
  }
  US_CHECK(!jobs.empty(), path, ": lists no job");
  return jobs;
}

Manifest read_manifest(const std::string& path, const std::vector<BatchCommand>& commands) {
  Manifest manifest{path, folder_of_file(path), {}};
  manifest.jobs = parse_manifest(read_file(path, kLargestManifest), path, commands);
  return manifest;
}

Json to_json(const BatchJob& job) {
  Json json{{"do", job.command}};
  if (!job.document.empty()) json["document"] = job.document;
  if (!job.sources.empty()) json["source"] = job.sources;
  if (!job.targets.empty()) json["target"] = job.targets;
  json["options"] = job.options;
  return json;
}

}  // namespace understudy::app
