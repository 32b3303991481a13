// What became of a batch: for people, and as one table.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/batch/results.hpp"

namespace understudy::app {

enum class JobState { Done, Failed, Left };

struct BatchStatus {
  size_t done = 0, failed = 0, left = 0;
  double median_s = 0;                                        ///< of those done; 0: none is
  std::vector<std::pair<std::string, std::string>> failures;  ///< id, sentence
};

/// By the records alone, of these jobs (see jobs_of): a job whose line has changed since it was done is left;
/// what has changed in its inputs the next run sees.
BatchStatus status_of(const Manifest& manifest, const std::vector<size_t>& jobs, const ResultFolder& results);
/// Lines for people.
std::string to_text(const BatchStatus& status);

/// A line for each person of each job, in the manifest's order: what was to be done, what came of it, doubt
/// and metrics, none of them a time. The same bytes whichever processes did the jobs.
std::string merged_csv(const Manifest& manifest, const ResultFolder& results);

}  // namespace understudy::app
