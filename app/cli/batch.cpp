#include <signal.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/batch/shard.hpp"
#include "app/batch/summary.hpp"
#include "app/cli/batch_job.hpp"
#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/cli/progress.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr int kSomeFailed = 3;  // exit code

struct BatchOptions {
  std::string manifest, out, merge;
  std::optional<std::string> shard;
  int shards = 0, jobs = 1;
  bool status = false;
};

Shard chosen_shard(const BatchOptions& options) {
  if (options.shard) return parse_shard(*options.shard);
  // A table is of all jobs wherever it is made.
  if (options.status || !options.merge.empty()) return {};
  return shard_from([](const char* name) { return std::getenv(name); }, options.shards);
}

/// Counts what becomes of jobs, for the one line at the end.
struct BatchCount {
  std::array<size_t, 4> ends{};  // by JobEnd
  size_t of(JobEnd end) const { return ends[static_cast<size_t>(end)]; }
  size_t finished() const { return of(JobEnd::Done) + of(JobEnd::Skipped) + of(JobEnd::Failed); }
};

BatchCount run_jobs(const Manifest& manifest, const std::vector<size_t>& jobs, const ResultFolder& results,
                    int processes) {
  BatchCount count;
  Progress progress(file_name(manifest.path), static_cast<int64_t>(jobs.size()), false, "job");
  ProcessPool pool;
  pool.processes = processes;
  pool.begin = [&] {
    const auto worker = std::make_shared<BatchWorker>(manifest, results);
    return [worker](size_t job) { return worker->run(job); };
  };
  pool.ended = [&](size_t job, JobEnd end) {
    ++count.ends[static_cast<size_t>(end)];
    const std::string& id = manifest.jobs[job].id;
    if (end == JobEnd::Failed) log::warn(id + ": " + results.failure(id).value_or("failed"));
    progress.step(static_cast<int64_t>(count.finished()));
  };
  pool.crashed = [&](size_t job, const std::string& how) {
    results.tell_failure(manifest.jobs[job], how, Json::array());
    pool.ended(job, JobEnd::Failed);
  };
  pool.stopped = [] { return interrupted(); };
  run_in_processes(jobs, pool);
  return count;
}

int run_batch(const BatchOptions& options, const Manifest& manifest, const std::vector<size_t>& jobs) {
  only_remember(SIGTERM);
  const ResultFolder results(std::filesystem::absolute(options.out).string());
  results.prepare();
  const BatchCount count = run_jobs(manifest, jobs, results, options.jobs);
  results.sweep();
  const size_t left = jobs.size() - count.finished();
  std::printf("%s: %zu done, %zu done before, %zu failed, %zu left\n", options.out.c_str(),
              count.of(JobEnd::Done), count.of(JobEnd::Skipped), count.of(JobEnd::Failed), left);
  std::fflush(stdout);
  US_CHECK(left == 0, "interrupted; what is done stays, and the same command goes on");
  return count.of(JobEnd::Failed) > 0 ? kSomeFailed : 0;
}

int batch(const BatchOptions& options) {
  check_not_read(options.merge, {options.manifest});
  const Shard shard = chosen_shard(options);
  const Manifest manifest = read_manifest(options.manifest, batch_commands());
  const std::vector<size_t> jobs = jobs_of(shard, manifest.jobs.size());
  if (shard.count > 1)
    log::info(
        printed("shard %d/%d: %zu of %zu jobs", shard.index, shard.count, jobs.size(), manifest.jobs.size()));
  if (!options.status && options.merge.empty()) return run_batch(options, manifest, jobs);
  const ResultFolder results(options.out);
  const BatchStatus status = status_of(manifest, jobs, results);
  if (!options.merge.empty()) write_file(options.merge, merged_csv(manifest, results));
  std::printf("%s", to_text(status).c_str());
  return status.failed > 0 ? kSomeFailed : 0;
}

}  // namespace

Action declare_batch(CLI::App& command) {
  const auto options = std::make_shared<BatchOptions>();
  command
      .add_option("manifest", options->manifest,
                  "JSON Lines, a job a line: {\"id\": \"s01\", \"do\": \"retarget\", \"source\": PATH, "
                  "\"target\": PATH, \"options\": {\"fps\": 25}}; options are those of retarget or export, "
                  "paths are from the manifest's folder on")
      ->required();
  command
      .add_option("--out", options->out,
                  "folder of the results: ID/ with a job's files, ID.done.json or ID.failed.json beside it")
      ->required();
  command.add_option("--shard", options->shard,
                     "I/N: every N-th job from the I-th on, from 0 (default: what Slurm's or Kubernetes' "
                     "environment says, else all)");
  command
      .add_option("--shards", options->shards,
                  "how many shards there are, where the environment says which one this is")
      ->check(CLI::Range(1, 1000000));
  command.add_option("--jobs", options->jobs, "processes at once, of one thread each (default: 1)")
      ->check(CLI::Range(1, 1024));
  CLI::Option* const status =
      command.add_flag("--status", options->status, "tells what is done, failed and left; does nothing");
  command.add_option("--merge", options->merge, "writes one CSV of all results, in the manifest's order")
      ->excludes(status);
  return [options] { return batch(*options); };
}

}  // namespace understudy::app
