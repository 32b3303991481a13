// Where a batch's results lie: OUT/ID with a job's files, OUT/ID.done.json or OUT/ID.failed.json beside it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/batch/inputs.hpp"
#include "app/batch/manifest.hpp"

namespace understudy::app {

/// Excludes all other processes that lock the same file, on other machines too where the file system can.
/// Where it cannot nobody is excluded. Waits.
class FileLock {
 public:
  /// The file is made where it is missing. Throws Error naming it when it cannot be.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_ = -1;
};

/// What is known of a job that was done. Its text has one order of members.
struct DoneRecord {
  std::string id, program, weights;  ///< weights: files with checksums, as reports have them
  Json job;                          ///< as to_json gives it
  std::vector<InputRecord> inputs;
  Json outputs = Json::array();   ///< [{"file", "bytes", "hash"}]
  double seconds = 0;             ///< what the job took
  Json results = Json::array();   ///< of each person: [{"person", "frames", "flagged", "doubt", "metrics"}]
  Json warnings = Json::array();  ///< sentences
};
Json to_json(const DoneRecord& record);
/// None where the file is missing or no such record.
std::optional<DoneRecord> read_done(const std::string& path);

/// The results' folder, for any number of processes at once.
class ResultFolder {
 public:
  /// Of that path; nothing is made. Throws Error where it is empty.
  explicit ResultFolder(const std::string& out);
  /// Makes it where it is missing. Throws Error.
  void prepare() const;
  /// Removes what processes left there that were killed.
  void sweep() const;

  const std::string& path() const { return out_; }
  std::string files(const std::string& id) const { return out_ + "/" + id; }
  std::string done_path(const std::string& id) const { return out_ + "/" + id + ".done.json"; }
  std::string failed_path(const std::string& id) const { return out_ + "/" + id + ".failed.json"; }
  std::string lock_path() const { return out_ + "/.lock"; }
  std::string work_path() const { return out_ + "/.work"; }

  /// Why it failed, where the last try did; none: it did not.
  std::optional<std::string> failure(const std::string& id) const;
  /// Whether all files that the record lists are there, in their sizes.
  bool has_outputs(const DoneRecord& record) const;
  /// "ID.failed.json", whole.
  void tell_failure(const BatchJob& job, const std::string& error, const Json& warnings) const;
  /// A failure is no longer one.
  void forget_failure(const std::string& id) const;

 private:
  std::string out_;
};

/// The folder in which one process makes a job's files before they appear: removed with this.
class WorkFolder {
 public:
  /// Throws Error.
  explicit WorkFolder(const ResultFolder& results);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  std::string folder(const std::string& id) const { return path_ + "/" + id; }
  /// A new, empty folder for a job's files. Throws Error.
  std::string begin(const std::string& id);
  /// Its files appear, whole, in place of those of an earlier run; then the record, whose outputs are filled
  /// in here. Throws Error where something else is in their place.
  void publish(DoneRecord record);

 private:
  const ResultFolder& results_;
  std::string path_;
  std::optional<FileLock> alive_;
};

}  // namespace understudy::app
