#include "retarget/base/log.hpp"

#include <cstdio>
#include <mutex>
#include <set>

#include "retarget/base/text.hpp"

namespace understudy::log {
namespace {

constexpr int64_t kMostOfAKind = 10;

void to_stderr(Level level, const std::string& message) {
  std::fprintf(stderr, "%s%s\n", level == Level::Warning ? "warning: " : "", message.c_str());
}

struct State {
  std::mutex mutex;
  Sink sink = to_stderr;
  std::set<std::string> logged;
};

State& state() {
  static State instance;
  return instance;
}

void emit(Level level, const std::string& message) {
  std::lock_guard lock(state().mutex);
  state().sink(level, message);
}

}  // namespace

Sink set_sink(Sink sink) {
  std::lock_guard lock(state().mutex);
  std::swap(sink, state().sink);
  return sink;
}

void info(const std::string& message) {
  emit(Level::Info, message);
}

void warn(const std::string& message) {
  emit(Level::Warning, message);
}

void warn_once(const std::string& message) {
  {
    std::lock_guard lock(state().mutex);
    if (!state().logged.insert(message).second) return;
  }
  warn(message);
}

void Tally::warn(const std::string& message) {
  if (++count_ <= kMostOfAKind) log::warn(message);
}

void Tally::finish() {
  if (count_ > kMostOfAKind) log::warn("and " + grouped(count_ - kMostOfAKind) + " more of these");
  count_ = 0;
}

}  // namespace understudy::log
