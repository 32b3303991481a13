// The example of the library must run as it is printed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::tests {
namespace {

TEST(MinimalExample, GivesALineForEachFrame) {
  const ScratchFolder scratch;
  write_scans(scratch.path("scans"), 3);
  write_target(scratch.path("target.obj"));
  const std::string command = std::string(US_PROGRAM).substr(0, std::string(US_PROGRAM).rfind('/')) +
                              "/retarget_minimal " + scratch.path("scans") + " " +
                              scratch.path("target.obj") + " > " + scratch.path("out");
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(line_count(read_bytes(scratch.path("out"))), 3);
}

TEST(MinimalExample, IsShort) {
  EXPECT_LT(line_count(read_bytes(US_SOURCE_DIR "/tests/example/retarget_minimal.cpp")), 40);
}

}  // namespace
}  // namespace understudy::tests
