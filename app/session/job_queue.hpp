// Background jobs: one thread per job, progress, an estimate of the time left, cancel; results arrive on the
// UI thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// A job's interface to the queue.
class JobControl {
 public:
  virtual ~JobControl() = default;
  /// 0..1.
  virtual void progress(float done) = 0;
  /// What is done now, after the job's name: "recording 12 of 80".
  virtual void tell(const std::string& doing) = 0;
  virtual bool cancelled() const = 0;
  /// Throws Cancelled once the user cancelled.
  void check() const;
};
struct Cancelled {};

/// For one thread, the UI's; only `Work` runs elsewhere.
class JobQueue {
 public:
  using Work = std::function<void(JobControl&)>;
  using Done = std::function<void()>;
  JobQueue();
  ~JobQueue();  ///< cancels and waits
  /// Calls `done` on the UI thread, in drain(), when the work ended without throwing.
  int64_t start(const std::string& name, Work work, Done done = {});
  void cancel(int64_t id);
  /// Whether any job runs, or waits for drain().
  bool running() const;
  /// A job that was not cancelled and failed.
  struct Failure {
    std::string sentence;
    std::string command;  ///< that started it, as a line; empty: none did
  };
  /// On the UI thread: calls `done` of finished jobs and returns those that failed.
  std::vector<Failure> drain();
  /// The command that runs now: of the jobs that are started from here on.
  void set_command(std::string line) { command_ = std::move(line); }
  std::vector<JobView> views() const;

 private:
  struct Job;
  std::vector<std::shared_ptr<Job>> jobs_;
  int64_t next_id_ = 1;
  std::string command_;
};

}  // namespace understudy::app
