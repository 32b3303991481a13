#include "app/session/job_queue.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/base/worker.hpp"

namespace understudy::app {
namespace {

using Clock = std::chrono::steady_clock;

/// The time left is shown after this much work or time; earlier it would be a guess from start-up.
constexpr float kTellingShare = 0.05f;
constexpr double kTellingSeconds = 1;

double seconds_left(float share, double elapsed_s) {
  if (share <= 0 || (share < kTellingShare && elapsed_s < kTellingSeconds)) return -1;
  return elapsed_s * (1 - share) / share;
}

}  // namespace

void JobControl::check() const {
  if (cancelled()) throw Cancelled{};
}

struct JobQueue::Job final : JobControl {
  int64_t id = 0;
  std::string name, command;
  Done done;
  Clock::time_point began = Clock::now();
  std::atomic<float> share{-1};
  std::atomic<bool> cancel{false};
  std::atomic<bool> ended{false};  // `failed` and `problem` are written before, and read after
  bool failed = false;
  std::string problem;  // empty for a job that fails silently
  mutable std::mutex telling;
  std::string doing;  // under the mutex
  std::thread thread;

  void progress(float value) override {
    if (std::isfinite(value)) share = std::clamp(value, 0.0f, 1.0f);
  }
  void tell(const std::string& words) override {
    const std::lock_guard lock(telling);
    doing = words;
  }
  bool cancelled() const override { return cancel; }

  void run(const Work& work) {
    failed = true;
    try {
      work(*this);
      failed = false;
    } catch (const Cancelled&) {
    } catch (const Error& error) {
      problem = error.what();
    } catch (const std::bad_alloc&) {
      problem = name + ": there is not enough memory";
    } catch (const std::exception& error) {
      problem = name + ": " + error.what();
    } catch (...) {
      problem = name + ": failed for an unknown reason";
    }
    if (cancel) problem.clear();  // whatever stopped it, the user knows why
    ended = true;
  }

  JobView view() const {
    JobView seen;
    seen.id = id;
    seen.name = name;
    seen.progress = share;
    {
      const std::lock_guard lock(telling);
      seen.doing = doing;
    }
    seen.cancellable = !cancel;
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - began).count();
    if (!cancel) seen.seconds_left = seconds_left(seen.progress, elapsed_s);
    return seen;
  }
};

JobQueue::JobQueue() = default;

JobQueue::~JobQueue() {
  for (const auto& job : jobs_) job->cancel = true;
  for (const auto& job : jobs_) job->thread.join();
}

int64_t JobQueue::start(const std::string& name, Work work, Done done) {
  auto job = std::make_shared<Job>();
  job->id = next_id_++;
  job->name = name;
  job->command = command_;
  job->done = std::move(done);
  jobs_.reserve(jobs_.size() + 1);  // from the thread's start on nothing may throw
  try {
    job->thread = std::thread([job = job.get(), work = std::move(work)] {
      yield_to_drawing();
      job->run(work);
    });
  } catch (const std::system_error&) {
    throw Error(name + ": the system allows no further thread");
  }
  jobs_.push_back(job);
  return job->id;
}

void JobQueue::cancel(int64_t id) {
  for (const auto& job : jobs_)
    if (job->id == id) job->cancel = true;
}

bool JobQueue::running() const {
  return !jobs_.empty();
}

std::vector<JobQueue::Failure> JobQueue::drain() {
  // Taken out first: what is done may start another job.
  const auto middle =
      std::stable_partition(jobs_.begin(), jobs_.end(), [](const auto& job) { return !job->ended; });
  const std::vector<std::shared_ptr<Job>> ended(middle, jobs_.end());
  jobs_.erase(middle, jobs_.end());

  for (const auto& job : ended) job->thread.join();

  std::vector<Failure> failures;
  for (const auto& job : ended) {
    try {
      if (!job->failed && job->done) job->done();
    } catch (const std::exception& error) {  // the other jobs' results must not be lost
      job->problem = error.what();
    }
    if (!job->problem.empty()) failures.push_back({job->problem, job->command});
  }
  return failures;
}

std::vector<JobView> JobQueue::views() const {
  std::vector<JobView> views;
  for (const auto& job : jobs_)
    if (!job->ended) views.push_back(job->view());
  return views;
}

}  // namespace understudy::app
