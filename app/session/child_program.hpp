// A program that runs beside this one, in a process of its own.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace understudy::app {

/// Use from one thread at a time.
class ChildProgram {
 public:
  /// Starts it, with this program's environment and priority and none of its files. Throws Error naming it.
  explicit ChildProgram(const std::vector<std::string>& command);
  ~ChildProgram();  ///< stops it
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  struct End {
    int code = -1;         ///< exit code; below 0: a signal ended it
    std::string out, err;  ///< the last line of each that says anything
  };
  /// None while it runs.
  std::optional<End> end();
  /// Asks it to end, and ends it when it has not after a second.
  void stop();

 private:
  int out_ = -1, err_ = -1;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace understudy::app
