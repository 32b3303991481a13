// Prints the progress of a job: one line that is overwritten on a terminal, else a line now and then.
#pragma once

#include <chrono>
#include <string>

namespace understudy::app {

class Progress {
 public:
  /// total 0: unknown. Writes to stderr. lines: new lines even on a terminal. item: what is counted; "":
  /// nothing, it is a share of the total.
  Progress(std::string what, int64_t total, bool lines = false, std::string item = "frame");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// `done` items are finished.
  void step(int64_t done);
  /// Ends the line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void show();
  std::string what_, item_;
  int64_t total_, done_ = 0, shown_ = 0;
  bool terminal_, open_ = false;
  Clock::time_point began_, last_;
};

}  // namespace understudy::app
