#include "app/batch/summary.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "retarget/base/text.hpp"
#include "retarget/metrics/metric_table.hpp"

namespace understudy::app {
namespace {

constexpr std::array<const char*, 3> kStateNames = {"done", "failed", "left"};

struct JobResult {
  JobState state = JobState::Left;
  std::string error;  // of one that failed
  DoneRecord record;  // of one that is done
};

JobResult result_of(const BatchJob& job, const ResultFolder& results) {
  JobResult result;
  if (const auto why = results.failure(job.id)) {
    result.state = JobState::Failed;
    result.error = *why;
    return result;
  }
  auto record = read_done(results.done_path(job.id));
  if (!record || record->job != to_json(job)) return result;
  result.state = JobState::Done;
  result.record = std::move(*record);
  return result;
}

/// As JSON has it; texts as they are, what is nothing empty.
std::string cell_of(const Json& value) {
  return value.is_null() ? std::string() : value.is_string() ? value.get<std::string>() : value.dump();
}

/// The place of a metric in its table; those that are not in it come behind, by name.
std::pair<size_t, std::string> place_of(const std::string& key) {
  const std::vector<Metric>& table = metric_table();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const Metric& metric) { return metric.key == key; });
  return {static_cast<size_t>(found - table.begin()), found == table.end() ? key : ""};
}

/// The members that any of the results has in an object of that name.
std::vector<std::string> keys_of(const std::vector<JobResult>& results, const char* object) {
  std::set<std::pair<std::pair<size_t, std::string>, std::string>> sorted;
  for (const JobResult& result : results)
    for (const Json& one : result.record.results)
      if (one.contains(object))
        for (const auto& item : one[object].items()) sorted.insert({place_of(item.key()), item.key()});
  std::vector<std::string> keys;
  keys.reserve(sorted.size());
  for (const auto& [place, key] : sorted) keys.push_back(key);
  return keys;
}

std::string names_of(const std::vector<std::string>& paths) {
  std::string names;
  for (const std::string& path : paths) append_item(names, path, ";");
  return names;
}

void add_line(const std::vector<std::string>& cells, std::string& text) {
  for (size_t i = 0; i < cells.size(); ++i) text += (i > 0 ? "," : "") + csv_cell(cells[i]);
  text += '\n';
}

}  // namespace

BatchStatus status_of(const Manifest& manifest, const std::vector<size_t>& jobs,
                      const ResultFolder& results) {
  BatchStatus status;
  std::vector<double> seconds;
  for (const size_t k : jobs) {
    const JobResult result = result_of(manifest.jobs[k], results);
    if (result.state == JobState::Done) ++status.done, seconds.push_back(result.record.seconds);
    if (result.state == JobState::Left) ++status.left;
    if (result.state != JobState::Failed) continue;
    ++status.failed;
    status.failures.emplace_back(manifest.jobs[k].id, result.error);
  }
  if (seconds.empty()) return status;
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  status.median_s = *middle;
  return status;
}

std::string to_text(const BatchStatus& status) {
  std::string text = printed("%zu done, %zu failed, %zu left", status.done, status.failed, status.left);
  if (status.done > 0) text += printed("; median %.2f s", status.median_s);
  text += '\n';
  for (const auto& [id, sentence] : status.failures) text += id + ": " + sentence + '\n';
  return text;
}

std::string merged_csv(const Manifest& manifest, const ResultFolder& results) {
  std::vector<JobResult> all;
  for (const BatchJob& job : manifest.jobs) all.push_back(result_of(job, results));
  const std::vector<std::string> doubts = keys_of(all, "doubt"), metrics = keys_of(all, "metrics");
  std::vector<std::string> cells = {"id",     "person", "state",  "error",  "do",
                                    "source", "target", "frames", "flagged"};
  for (const std::string& key : doubts) cells.push_back("doubt_" + key);
  cells.insert(cells.end(), metrics.begin(), metrics.end());
  std::string text;
  add_line(cells, text);
  for (size_t k = 0; k < all.size(); ++k) {
    const BatchJob& job = manifest.jobs[k];
    Json rows = all[k].record.results;
    if (rows.empty()) rows.push_back(Json::object());
    for (const Json& row : rows) {
      const auto cell = [&](const Json& object, const std::string& key) {
        return object.contains(key) ? cell_of(object[key]) : std::string();
      };
      const Json none = Json::object();
      const Json &doubt = row.contains("doubt") ? row["doubt"] : none,
                 &figures = row.contains("metrics") ? row["metrics"] : none;
      cells = {job.id, cell(row, "person"), kStateNames[static_cast<size_t>(all[k].state)], all[k].error,
               job.command};
      cells.push_back(job.document.empty() ? names_of(job.sources) : job.document);
      cells.push_back(names_of(job.targets));
      for (const char* key : {"frames", "flagged"}) cells.push_back(cell(row, key));
      for (const std::string& key : doubts) cells.push_back(cell(doubt, key));
      for (const std::string& key : metrics) cells.push_back(cell(figures, key));
      add_line(cells, text);
    }
  }
  return text;
}

}  // namespace understudy::app
