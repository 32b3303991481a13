// Blender imports and plays what we export. Not among the tests of every day: UNDERSTUDY_BLENDER names the
// program.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "retarget/base/error.hpp"
#include "tests/app/program.hpp"
#include "tests/interop/exported.hpp"

namespace understudy::tests {
namespace {

TEST(Blender, PlaysEveryExportAsWeDo) {
  const char* blender = std::getenv("UNDERSTUDY_BLENDER");
  ASSERT_NE(blender, nullptr) << "UNDERSTUDY_BLENDER names no program";
  std::vector<PlayJob> jobs;
  for (const Exported& exported : all_exported()) jobs.push_back(exported.job("blender"));
  ProgramOptions options;
  options.program = blender;
  options.patience_s = 300;
  const Finished done = run_program({"-b", "--factory-startup", "--python-exit-code", "3", "--python",
                                     US_SOURCE_DIR "/tests/interop/blender_play.py", "--", write_jobs(jobs)},
                                    options);
  ASSERT_EQ(done.code, 0) << done.err.substr(0, 2000) << done.out.substr(done.out.size() / 2);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const Exported& exported = all_exported()[i];
    const auto theirs = read_positions(jobs[i], exported.file.vertex_count());
    const Agreement found = agreement(exported, theirs, 8);
    std::printf("%-40s against our reader %.4f mm, against the screen %.4f mm (stated: %.4f mm)\n",
                exported.name.c_str(), found.ours_mm, found.screen_mm, exported.cost_mm);
    // Between few keys Blender goes along the chord of a turn, we along the arc: within what was allowed for.
    EXPECT_LT(found.ours_mm, 0.1 + static_cast<double>(exported.options.reduce_mm)) << exported.name;
    EXPECT_LT(found.screen_mm, exported.cost_mm + 0.1) << exported.name;
  }
}

}  // namespace
}  // namespace understudy::tests
