// A background thread that does one thing after another and never takes the program along.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace understudy {

/// Lowers the calling thread's priority, so that input and drawing come first.
void yield_to_drawing();

/// Asks its owner for the next task, does it, and asks again; sleeps while there is none. What owner and
/// tasks share is guarded by its mutex. An exception of a task is logged, and the next one is done. Its
/// owner declares it last: its end waits for the task at work, and no other begins.
class Worker {
 public:
  using Task = std::function<void()>;  ///< runs without the mutex
  enum class Priority { YieldsToDrawing, AsDrawing };
  /// Called with the mutex held; an empty task: nothing is to be done. Throws Error, naming `name`, when the
  /// system allows no further thread.
  Worker(std::string name, std::function<Task()> next, Priority priority = Priority::YieldsToDrawing);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Held by whoever reads or writes what is shared.
  [[nodiscard]] std::unique_lock<std::mutex> lock() const { return std::unique_lock<std::mutex>(mutex_); }
  /// There may be a task.
  void wake() { wake_.notify_all(); }
  /// Whether a task is being done; with the mutex held.
  bool working() const { return working_; }
  /// Waits until a condition on what is shared holds; it is looked at after each task and before sleep.
  void wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& holds) const;

 private:
  void run(Priority priority);

  std::string name_;
  std::function<Task()> next_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  mutable std::condition_variable rested_;
  bool stop_ = false, working_ = false;
  std::thread thread_;  // last: it uses all others
};

}  // namespace understudy
