// Time that passes.
#pragma once

#include <chrono>

namespace understudy {

/// Milliseconds.
inline double ms_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace understudy
