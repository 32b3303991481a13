// Blender imports and plays what we export. Not among the tests of every day: UNDERSTUDY_BLENDER names the
// program.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "app/run/exports.hpp"
#include "retarget/base/error.hpp"
#include "tests/app/program.hpp"
#include "tests/interop/exported.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

/// Has Blender do the jobs by a script of tests/interop.
void run_blender(const std::string& script, const std::vector<PlayJob>& jobs) {
  const char* blender = std::getenv("UNDERSTUDY_BLENDER");
  ASSERT_NE(blender, nullptr) << "UNDERSTUDY_BLENDER names no program";
  ProgramOptions options;
  options.program = blender;
  options.patience_s = 300;
  const Finished done = run_program({"-b", "--factory-startup", "--python-exit-code", "3", "--python",
                                     US_SOURCE_DIR "/tests/interop/" + script, "--", write_jobs(jobs)},
                                    options);
  ASSERT_EQ(done.code, 0) << done.err.substr(0, 2000) << done.out.substr(done.out.size() / 2);
}

TEST(Blender, PlaysEveryExportAsWeDo) {
  std::vector<PlayJob> jobs;
  for (const Exported& exported : all_played()) jobs.push_back(exported.job("blender"));
  ASSERT_NO_FATAL_FAILURE(run_blender("blender_play.py", jobs));
  for (size_t i = 0; i < jobs.size(); ++i) {
    const Exported& exported = all_played()[i];
    const auto theirs = read_positions(jobs[i], exported.file.vertex_count());
    const Agreement found = agreement(exported, theirs, 8);
    std::printf("%-40s against our reader %.4f mm, against the screen %.4f mm (stated: %.4f mm)\n",
                exported.name.c_str(), found.ours_mm, found.screen_mm, exported.cost_mm);
    // Between few keys Blender goes along the chord of a turn, we along the arc: within what was allowed for.
    EXPECT_LT(found.ours_mm, 0.1 + static_cast<double>(exported.options.reduce_mm)) << exported.name;
    EXPECT_LT(found.screen_mm, exported.cost_mm + 0.1) << exported.name;
  }
}

TEST(Blender, MovesTheMeshByThePointCacheAsWeDo) {
  const ScratchFolder folder;
  app::ExportInput input;
  const auto character =
      std::make_shared<const PreparedCharacter>(prepare_character(make_character(), nullptr, nullptr));
  const auto screen = std::make_shared<BulgingDeformer>(0.02f);
  screen->bind(character->target.mesh.vertices, character->target.joints);
  input.body = {character, screen, {}};
  constexpr int kFrames = 25, kTimes = 5;
  const std::vector<Pose> poses = made_motion(kFrames, character->target.joints);
  input.clips = {{"walk", 25, poses}};
  PlayJob job{folder.path("walk.pc2"), folder.path("walk.blender"), 0, 25, {}};
  app::export_motion(job.file, app::export_format("pc2", ""), {input});
  for (int i = 0; i < kTimes; ++i)
    job.times.push_back(static_cast<float>(i * (kFrames - 1) / (kTimes - 1)) / 25);
  ASSERT_NO_FATAL_FAILURE(run_blender("blender_cache.py", {job}));
  const auto theirs = read_positions(job, static_cast<Eigen::Index>(character->surface.in_file.size()));
  ASSERT_EQ(theirs.size(), size_t{kTimes});
  double worst = 0;
  for (int i = 0; i < kTimes; ++i) {
    const Pose& pose = poses[static_cast<size_t>(i * (kFrames - 1) / (kTimes - 1))];
    const Points ours = character->surface.in_file_order(screen->deform(pose));
    worst = std::max(worst, largest_mm(theirs[static_cast<size_t>(i)], ours));
  }
  std::printf("point cache: against the screen %.4f mm at most\n", worst);
  EXPECT_LT(worst, 0.01);
}

}  // namespace
}  // namespace understudy::tests
