#include "retarget/base/threads.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace understudy {
namespace {

TEST(UsableThreads, AreNoMoreThanAllowedAndOneAtLeast) {
  const int cores = usable_threads();
  EXPECT_GE(cores, 1);
  limit_threads(1);
  EXPECT_EQ(usable_threads(), 1);
  limit_threads(0);
  EXPECT_EQ(usable_threads(), 1);
  limit_threads(std::numeric_limits<int>::max());
  EXPECT_EQ(usable_threads(), cores);
}

}  // namespace
}  // namespace understudy
