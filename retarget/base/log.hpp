// Messages for people: one sink, stderr by default, replaced by the window's console.
#pragma once

#include <functional>
#include <string>

namespace understudy::log {

enum class Level { Info, Warning };
using Sink = std::function<void(Level, const std::string&)>;

/// Replaces the sink and returns the one before. Thread-safe.
Sink set_sink(Sink sink);
void info(const std::string& message);
void warn(const std::string& message);
/// The same message is told once per process only.
void warn_once(const std::string& message);

}  // namespace understudy::log
