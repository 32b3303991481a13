#include "tests/session/crash_trace.hpp"

#include <execinfo.h>
#include <signal.h>
#include <unistd.h>

#include <cstring>

#ifndef __has_feature  // clang's
#define __has_feature(name) 0
#endif

namespace understudy::app {
namespace {

// A sanitizer tells it itself, and more of it.
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
constexpr int kFatalSignals[] = {SIGILL, SIGSEGV, SIGBUS, SIGFPE};

void write_text(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody listens
}

/// Only what is safe in a signal handler.
void tell_crash(int signal, siginfo_t* info, void*) {
  write_text("crashed: ");
  write_text(sigabbrev_np(signal));
  void* places[64] = {info->si_addr};
  write_text(", at and from:\n");
  const int count = ::backtrace(places + 1, 63) + 1;
  ::backtrace_symbols_fd(places, count, STDERR_FILENO);
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace

void tell_where_it_crashes() {
  if (kSanitized) return;
  void* warm[1];
  ::backtrace(warm, 1);  // it loads a library the first time, which a handler must not
  struct sigaction action {};
  action.sa_sigaction = tell_crash;
  action.sa_flags = SA_SIGINFO;
  for (const int signal : kFatalSignals) ::sigaction(signal, &action, nullptr);
}

}  // namespace understudy::app
