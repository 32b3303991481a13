// One job of a batch: a line of its manifest, done as the subcommand of that name does it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/batch/processes.hpp"
#include "app/batch/results.hpp"

namespace understudy::app {

/// The subcommands that a line may name, the first where it names none, with the options that they declare.
std::vector<BatchCommand> batch_commands();

/// Does jobs one after the other in a process that does nothing else: one thread, the manifest's folder as
/// the working folder, silent.
class BatchWorker {
 public:
  /// Changes the process so. Both must outlive it; the path of `results` is absolute. Throws Error.
  BatchWorker(const Manifest& manifest, const ResultFolder& results);
  ~BatchWorker();
  BatchWorker(const BatchWorker&) = delete;
  BatchWorker& operator=(const BatchWorker&) = delete;

  /// Its files and its record, or the sentence of its failure, are there afterwards, but where it was
  /// stopped. Throws Error where not even a failure can be told.
  JobEnd run(size_t job);

 private:
  JobEnd attempt(const BatchJob& job);
  DoneRecord begin(const BatchJob& job);
  bool is_done(const BatchJob& job, const DoneRecord& before);
  const std::string& weights_in(const BatchJob& job);

  const Manifest& manifest_;
  const ResultFolder& results_;
  WorkFolder work_;
  std::map<std::string, std::string> weights_;  // checksums by folder
  Json warnings_ = Json::array();               // of the job at work
};

}  // namespace understudy::app
