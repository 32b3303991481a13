#include "retarget/base/threads.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

namespace understudy {
namespace {

std::atomic<int> limit{std::numeric_limits<int>::max()};

}  // namespace

int usable_threads() {
  const auto cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return std::clamp(cores, 1, std::max(1, limit.load()));
}

void limit_threads(int most) {
  limit = most;
}

}  // namespace understudy
