#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "app/run/fields_json.hpp"
#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPrefix = "autosave_";
constexpr const char* kSuffix = ".understudy";
constexpr const char* kAutosaveFormat = "understudy autosave";

/// A process that no other has ever been: numbers are given again, but not within one boot at one moment.
struct Owner {
  std::string boot;  // of the machine
  int64_t process = 0;
  int64_t started = 0;  // ticks after the boot
  bool operator==(const Owner& other) const {
    return boot == other.boot && process == other.process && started == other.started;
  }
};

std::string boot_id() {
  std::string id;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), id);
  id.erase(std::remove(id.begin(), id.end(), '-'), id.end());
  return id.empty() ? "unknown" : id;
}

/// When a process started, ticks after the boot; none where no such process runs. A dead one that nobody has
/// waited for yet runs no more.
std::optional<int64_t> start_of(int64_t process) {
  std::string line;
  std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), line);
  const size_t name_end = line.rfind(')');  // the name may hold anything, parentheses too
  if (name_end == std::string::npos) return {};
  std::istringstream rest(line.substr(name_end + 1));
  std::string state, word;
  rest >> state;
  for (int field = 4; field < 22; ++field) rest >> word;
  int64_t started = 0;
  if (state == "Z" || state == "X" || !(rest >> started)) return {};
  return started;
}

const Owner& myself() {
  static const Owner me{boot_id(), getpid(), start_of(getpid()).value_or(0)};
  return me;
}

std::string copy_name(const Owner& owner) {
  return kPrefix + owner.boot + '_' + std::to_string(owner.process) + '_' + std::to_string(owner.started) +
         kSuffix;
}

/// The process that wrote a copy; none for other files, unfinished ones ("....part") included.
std::optional<Owner> owner_of(const std::string& name) {
  const size_t begin = std::string(kPrefix).size(), end = name.rfind(kSuffix);
  if (!starts_with(name, kPrefix) || end == std::string::npos || end < begin) return {};
  std::string words = name.substr(begin, end - begin);
  std::replace(words.begin(), words.end(), '_', ' ');
  std::istringstream in(words);
  Owner owner;
  if (!(in >> owner.boot >> owner.process >> owner.started)) return {};
  return copy_name(owner) == name.substr(0, end + std::string(kSuffix).size()) ? std::optional(owner)
                                                                               : std::nullopt;
}

bool runs(const Owner& owner) {
  return owner.boot == myself().boot && start_of(owner.process) == owner.started;
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
  return text;
}

std::string text_in(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

/// Whether a newer program made it: not damaged, but not for this one.
bool is_newer(const Json& copy) {
  const Json* document = copy.is_object() && copy.contains("document") ? &copy["document"] : nullptr;
  if (!document || !document->is_object() || !document->contains("version")) return false;
  const Json& version = (*document)["version"];
  return version.is_number_integer() && version > kDocumentVersion;
}

/// The document in a copy. Throws Error.
SavedDocument document_in(const Json& copy, const std::string& file) {
  US_CHECK(copy.is_object() && text_in(copy, "format") == kAutosaveFormat && copy.contains("document"), file,
           ": is not an autosaved document");
  return from_json(copy["document"], "", file);
}

void set_aside(const std::string& file, const std::string& problem) {
  std::error_code error;
  fs::rename(file, file + ".damaged", error);
  log::warn("an autosaved document cannot be read and was set aside" +
            std::string(error ? "" : " as " + file + ".damaged") + ": " + problem);
}

}  // namespace

void write_autosave(const std::string& folder, const SavedDocument& saved, const std::string& document_path) {
  std::error_code error;
  fs::create_directories(folder, error);
  US_CHECK(!error, folder, ": cannot be made (", error.message(), ")");
  const Json json{{"format", kAutosaveFormat},
                  {"document_path", document_path},
                  {"time", local_time()},
                  {"document", to_json(saved, "")}};
  write_file((fs::path(folder) / copy_name(myself())).string(), json_text(json));
}

void remove_autosave(const std::string& folder) {
  std::error_code ignored;
  fs::remove(fs::path(folder) / copy_name(myself()), ignored);
}

std::vector<Autosave> found_autosaves(const std::string& folder) {
  std::vector<Autosave> found;
  std::error_code error;
  std::vector<fs::path> files;  // first all, since some will be renamed
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    files.push_back(entry->path());
  for (const fs::path& path : files) {
    const std::string name = path.filename().string();
    const std::optional<Owner> owner = owner_of(name);
    if (!owner || runs(*owner)) continue;
    if (ends_with(name, ".part")) fs::remove(path, error);  // died while it was written
    if (!ends_with(name, kSuffix)) continue;
    try {
      const Json copy = read_json(path.string());
      if (is_newer(copy)) continue;
      document_in(copy, path.string());  // throws when it cannot be recovered
      found.push_back({path.string(), text_in(copy, "document_path"), text_in(copy, "time")});
    } catch (const Error& problem) {
      set_aside(path.string(), problem.what());
    }
  }
  std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.time > b.time; });
  return found;
}

SavedDocument read_autosave(const Autosave& autosave) {
  return document_in(read_json(autosave.file), autosave.file);
}

void discard(const Autosave& autosave) {
  std::error_code error;
  fs::remove(autosave.file, error);
  US_CHECK(!error, autosave.file, ": cannot be removed (", error.message(), ")");
}

}  // namespace understudy::app
