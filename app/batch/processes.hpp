// Jobs shared out to processes of this program: each asks for the next one when it has done its last.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace understudy::app {

/// How a job ended in its process.
enum class JobEnd : uint8_t { Done, Skipped, Failed, Stopped };

struct ProcessPool {
  int processes = 1;
  /// In a new process, before its first job; gives what does a job there. Its result is destroyed at the
  /// process' end. What it throws ends the pool.
  std::function<std::function<JobEnd(size_t job)>()> begin;
  /// Here: how a job ended.
  std::function<void(size_t job, JobEnd end)> ended;
  /// Here: the process of a job was ended by a fault, told in one sentence. Another process goes on.
  std::function<void(size_t job, const std::string& how)> crashed;
  /// Here, several times a second: true asks all processes, by SIGTERM, to stop between frames.
  std::function<bool()> stopped;
};

/// Returns when all are done or, once stopped, when no process is left. They do not outlive this one. Throws
/// Error where processes cannot be made. Call it while this process has one thread.
void run_in_processes(const std::vector<size_t>& jobs, const ProcessPool& pool);

}  // namespace understudy::app
