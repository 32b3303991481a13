// three.js in a real browser plays what we export, vertex by vertex as we do.
#include <gtest/gtest.h>

#include "tests/interop/exported.hpp"

namespace understudy::tests {
namespace {

TEST(Three, PlaysAndDrawsEveryExportAsWeDo) {
  std::vector<PlayJob> jobs;
  for (const Exported& exported : all_played()) jobs.push_back(exported.job("three"));
  const auto said = run_script("three_play.mjs", {"chromium", write_jobs(jobs)});
  ASSERT_EQ(said.size(), jobs.size());
  for (size_t i = 0; i < jobs.size(); ++i) {
    const Exported& exported = all_played()[i];
    ASSERT_FALSE(said[i].contains("failed")) << exported.name << ": " << said[i]["failed"];
    EXPECT_EQ(said[i]["clips"].size(), exported.file.animations.size()) << exported.name;
    EXPECT_EQ(said[i]["clips"][static_cast<size_t>(exported.clip)], "walk") << exported.name;
    EXPECT_GT(said[i].value("covered", 0.0), 0.005) << exported.name << " is hardly to be seen";
    const auto theirs = read_positions(jobs[i], exported.file.vertex_count());
    const Agreement found = agreement(exported, theirs, 4);  // three.js knows four influences
    RecordProperty(exported.name, std::to_string(found.ours_mm));
    EXPECT_LT(found.ours_mm, 0.1) << exported.name;
    if (!needs_eight(exported)) EXPECT_LT(found.screen_mm, exported.cost_mm + 0.1) << exported.name;
  }
}

}  // namespace
}  // namespace understudy::tests
