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
  /// On the UI thread: calls `done` of finished jobs and returns the sentences of those that failed (none for
  /// cancelled ones).
  std::vector<std::string> drain();
  std::vector<JobView> views() const;

 private:
  struct Job;
  std::vector<std::shared_ptr<Job>> jobs_;
  int64_t next_id_ = 1;
};

}  // namespace understudy::app
