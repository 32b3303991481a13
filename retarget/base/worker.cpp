#include "retarget/base/worker.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy {

void yield_to_drawing() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);  // a thread of its own, on Linux
}

Worker::Worker(std::string name, std::function<Task()> next, Priority priority)
    : name_(std::move(name)), next_(std::move(next)) {
  try {
    thread_ = std::thread([this, priority] { run(priority); });
  } catch (const std::system_error&) {
    throw Error(name_ + ": the system allows no further thread");
  }
}

Worker::~Worker() {
  {
    const auto held = lock();
    stop_ = true;
  }
  wake();
  thread_.join();
}

void Worker::run(Priority priority) {
  if (priority == Priority::YieldsToDrawing) yield_to_drawing();
  auto held = lock();
  while (!stop_) {
    Task task;
    std::string problem = failure_of([&] { task = next_(); });
    if (task) {
      working_ = true;
      held.unlock();
      problem = failure_of(task);
      task = nullptr;  // what it holds may be large
      held.lock();
      working_ = false;
      rested_.notify_all();
    } else if (problem.empty()) {
      rested_.notify_all();
      wake_.wait(held);
    }
    if (!problem.empty()) log::warn(name_ + ": " + problem);
  }
}

void Worker::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& holds) const {
  rested_.wait(lock, holds);
}

}  // namespace understudy
