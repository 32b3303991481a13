#include "retarget/base/log.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace understudy {
namespace {

TEST(LogTally, TellsTenAndSumsUpTheOthers) {
  std::vector<std::string> told;
  const auto before = log::set_sink([&](log::Level, const std::string& message) { told.push_back(message); });
  log::Tally series;
  for (int i = 0; i < 1010; ++i) series.warn("frame " + std::to_string(i));
  series.finish();
  log::Tally few;
  few.warn("alone");
  few.finish();
  log::set_sink(before);
  ASSERT_EQ(told.size(), 12u);
  EXPECT_EQ(told[9], "frame 9");
  EXPECT_EQ(told[10], "and 1,000 more of these");
  EXPECT_EQ(told[11], "alone");
}

}  // namespace
}  // namespace understudy
