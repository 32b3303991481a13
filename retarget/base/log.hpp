// Messages for people: one sink, stderr by default, replaced by the window's console.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace understudy::log {

enum class Level { Info, Warning };
using Sink = std::function<void(Level, const std::string&)>;

/// Replaces the sink and returns the one before. Thread-safe.
Sink set_sink(Sink sink);
void info(const std::string& message);
void warn(const std::string& message);
/// Logs a message once per process only.
void warn_once(const std::string& message);

/// Warnings of one kind, of which there may be one a frame: ten are logged, the others are counted.
class Tally {
 public:
  void warn(const std::string& message);
  /// "and 99,990 more of these"; nothing where all were logged.
  void finish();

 private:
  int64_t count_ = 0;
};

}  // namespace understudy::log
