#include "retarget/formats/file_formats.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace understudy {
namespace {

/// Runs after what was made later is destroyed.
void ask_at_the_end() {
  if (format_of_suffix("scan.ply", kScanFrame) == nullptr) std::_Exit(3);
}

TEST(FileFormatsDeathTest, AreThereForAThreadThatOutlivesMain) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process that has not used the table before
  const auto end = [] {
    std::atexit(ask_at_the_end);
    file_formats();
    std::exit(0);
  };
  EXPECT_EXIT(end(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace understudy
