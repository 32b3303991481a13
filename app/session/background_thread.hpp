// Threads that must not take the processor from the one that draws.
#pragma once

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace understudy::app {

/// Lowers the calling thread's priority: input and pictures come first, frames in the making second.
inline void yield_to_drawing() {
  constexpr int kNice = 3;
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);  // a thread of its own, on Linux
}

}  // namespace understudy::app
