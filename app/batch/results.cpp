#include "app/batch/results.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

#include "app/run/fields_json.hpp"
#include "app/run/version.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kLargestRecord = uint64_t{64} << 20;

int open_lock(const std::string& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
}

/// Of an open file, not of a process: it ends with whoever has the file open, however they end.
bool lock_whole(int file, int how) {
  struct flock all {};
  all.l_type = F_WRLCK;
  all.l_whence = SEEK_SET;
  int done = -1;
  do done = ::fcntl(file, how, &all);
  while (done != 0 && errno == EINTR);
  return done == 0;
}

/// Whether nobody works in such a folder any more.
bool is_left_behind(const fs::path& folder) {
  const int file = ::open((folder / "alive").c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return errno == ENOENT;
  const bool is_free = lock_whole(file, F_OFD_SETLK);
  ::close(file);
  return is_free;
}

/// Paths below it of all files inside, sorted.
std::vector<std::string> files_below(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!entry.is_directory()) files.push_back(fs::relative(entry.path(), folder).string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Whether nothing is lost with what is there but files of these names.
bool holds_only(const std::string& folder, const std::vector<std::string>& files) {
  if (!fs::is_directory(folder)) return false;
  const std::set<std::string> known(files.begin(), files.end());
  const std::vector<std::string> there = files_below(folder);
  return std::all_of(there.begin(), there.end(),
                     [&](const std::string& one) { return known.count(one) > 0; });
}

void make_folder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  US_CHECK(!failed && fs::is_directory(path), path, ": this folder cannot be made",
           failed ? " (" + failed.message() + ")" : "");
}

void move(const std::string& from, const std::string& to) {
  std::error_code failed;
  fs::rename(from, to, failed);
  US_CHECK(!failed, to, ": cannot be written (", failed.message(), ")");
}

std::string process_name() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return std::string(host.data()) + "-" + std::to_string(::getpid());
}

}  // namespace

FileLock::FileLock(const std::string& path) : file_(open_lock(path)) {
  US_CHECK(file_ >= 0, path, ": cannot be written (", std::strerror(errno), ")");
  lock_whole(file_, F_OFD_SETLKW);
}

FileLock::~FileLock() {
  ::close(file_);
}

Json to_json(const DoneRecord& record) {
  Json inputs = Json::array();
  for (const InputRecord& one : record.inputs) inputs.push_back(to_json(one));
  return {{"id", record.id},           {"program", record.program}, {"job", record.job},
          {"inputs", inputs},          {"weights", record.weights}, {"outputs", record.outputs},
          {"seconds", record.seconds}, {"results", record.results}, {"warnings", record.warnings}};
}

std::optional<DoneRecord> read_done(const std::string& path) {
  std::error_code failed;
  if (!fs::exists(path, failed)) return std::nullopt;
  DoneRecord record;
  const std::string problem = failure_of([&] {
    const Json json = Json::parse(read_file(path, kLargestRecord));
    record.id = json.at("id").get<std::string>();
    record.program = json.at("program").get<std::string>();
    record.job = json.at("job");
    for (const Json& one : json.at("inputs")) record.inputs.push_back(input_record(one));
    record.weights = json.at("weights").get<std::string>();
    record.outputs = json.at("outputs");
    record.seconds = json.at("seconds").get<double>();
    record.results = json.at("results");
    record.warnings = json.at("warnings");
  });
  return problem.empty() ? std::optional<DoneRecord>(record) : std::nullopt;
}

ResultFolder::ResultFolder(const std::string& out) : out_(fs::path(out).lexically_normal().string()) {
  US_CHECK(!out.empty(), "--out: a folder without a name cannot be written");
}

void ResultFolder::prepare() const {
  make_folder(work_path());
  sweep();
}

void ResultFolder::sweep() const {
  const FileLock lock(lock_path());
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(work_path(), ignored))
    if (is_left_behind(entry.path())) fs::remove_all(entry.path(), ignored);
}

std::optional<std::string> ResultFolder::failure(const std::string& id) const {
  const std::string path = failed_path(id);
  std::error_code none;
  if (!fs::exists(path, none)) return std::nullopt;
  std::string sentence = "it is not known why";
  failure_of([&] { sentence = Json::parse(read_file(path, kLargestRecord)).at("error").get<std::string>(); });
  return sentence;
}

bool ResultFolder::has_outputs(const DoneRecord& record) const {
  bool good = !record.outputs.empty();
  const std::string problem = failure_of([&] {
    for (const Json& output : record.outputs) {
      const std::string file = files(record.id) + "/" + output.at("file").get<std::string>();
      good = good && check_file(file) == output.at("bytes").get<uint64_t>();
    }
  });
  return good && problem.empty();
}

void ResultFolder::tell_failure(const BatchJob& job, const std::string& error, const Json& warnings) const {
  const Json json{
      {"id", job.id}, {"program", kProgram}, {"job", to_json(job)}, {"error", error}, {"warnings", warnings}};
  write_file(failed_path(job.id), json_text(json), /*synced=*/false);
}

void ResultFolder::forget_failure(const std::string& id) const {
  std::error_code ignored;
  fs::remove(failed_path(id), ignored);
}

WorkFolder::WorkFolder(const ResultFolder& results)
    : results_(results), path_(results.work_path() + "/" + process_name()) {
  const FileLock lock(results.lock_path());  // nobody takes the folder for one left behind
  std::error_code ignored;
  fs::remove_all(path_, ignored);  // of a process that had this one's number
  make_folder(path_);
  alive_.emplace(path_ + "/alive");
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string WorkFolder::begin(const std::string& id) {
  std::string folder = this->folder(id);
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  make_folder(folder);
  return folder;
}

void WorkFolder::publish(DoneRecord record) {
  const std::string made = path_ + "/" + record.id, there = results_.files(record.id), old = path_ + "/.old";
  const std::vector<std::string> files = files_below(made);
  US_CHECK(!files.empty(), record.id, ": nothing was written");
  record.outputs = Json::array();
  for (const std::string& file : files)
    record.outputs.push_back({{"file", file},
                              {"bytes", check_file(made + "/" + file)},
                              {"hash", checksum_of_file(made + "/" + file)}});
  const std::string text = path_ + "/.done.json";
  write_file(text, json_text(to_json(record)));

  const FileLock lock(results_.lock_path());
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(there, ignored))) {
    US_CHECK(read_done(results_.done_path(record.id)) || holds_only(there, files), there,
             ": exists and was not made by a batch; it is left as it is");
    fs::remove_all(old, ignored);
    move(there, old);
  }
  move(made, there);
  move(text, results_.done_path(record.id));
  results_.forget_failure(record.id);
  fs::remove_all(old, ignored);
}

}  // namespace understudy::app
