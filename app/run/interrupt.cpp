#include "app/run/interrupt.hpp"

#include <atomic>
#include <csignal>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

std::atomic<bool> pressed{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

void remember(int signal) {
  pressed = true;
  std::signal(signal, SIG_DFL);
}

void remember_each(int) {
  pressed = true;
}

}  // namespace

void only_remember(int signal) {
  std::signal(signal, remember_each);
}

void catch_interrupts() {
  std::signal(SIGINT, remember);
  std::signal(SIGTERM, remember);
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the allowed size is then a failed write like a full disk
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return pressed;
}

void check_interrupt(const std::string& where) {
  US_CHECK(!pressed, "interrupted ", where, "; nothing was written");
}

}  // namespace understudy::app
