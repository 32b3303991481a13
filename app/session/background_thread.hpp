// Background threads run at lower priority than the thread that draws.
#pragma once

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace understudy::app {

/// Lowers the calling thread's priority, so that input and drawing come first.
inline void yield_to_drawing() {
  constexpr int kNice = 3;
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);  // a thread of its own, on Linux
}

}  // namespace understudy::app
