#include "app/cli/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace understudy::app {

Progress::Progress(std::string what, int64_t total, bool lines, std::string item)
    : what_(std::move(what)),
      item_(std::move(item)),
      total_(total),
      terminal_(!lines && isatty(2) == 1),
      began_(Clock::now()),
      last_(began_) {}

Progress::~Progress() {
  finish();
}

void Progress::step(int64_t done) {
  done_ = done;
  const double pause = std::chrono::duration<double>(Clock::now() - last_).count();
  if (pause >= (terminal_ ? 0.1 : 2.0)) show();
}

void Progress::show() {
  last_ = Clock::now();
  const double seconds = std::chrono::duration<double>(last_ - began_).count();
  const double rate = seconds > 0 ? static_cast<double>(done_) / seconds : 0;
  std::fprintf(stderr, "%s%s: ", terminal_ ? "\r" : "", what_.c_str());
  if (item_.empty()) {
    std::fprintf(stderr, "%.0f %%", 100 * static_cast<double>(done_) / static_cast<double>(total_));
  } else {
    std::fprintf(stderr, "%s %lld", item_.c_str(), static_cast<long long>(done_));
    if (total_ > 0) std::fprintf(stderr, " of %lld", static_cast<long long>(total_));
    std::fprintf(stderr, ", %.1f %ss/s", rate, item_.c_str());
  }
  std::fprintf(stderr, "%s", terminal_ ? "  " : "\n");
  std::fflush(stderr);
  open_ = terminal_;
  shown_ = done_;
}

void Progress::finish() {
  if (done_ > shown_ && open_) show();
  if (open_) std::fputc('\n', stderr);
  open_ = false;
}

}  // namespace understudy::app
