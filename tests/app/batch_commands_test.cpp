#include <gtest/gtest.h>

#include "app/cli/batch_job.hpp"

namespace understudy::app {
namespace {

using Path = BatchOption::Path;

const BatchCommand& command(const std::string& name) {
  static const std::vector<BatchCommand> all = batch_commands();
  return all[name == "retarget" ? 0 : 1];
}

TEST(BatchCommands, KnowWhichOptionsArePaths) {
  for (const char* name : {"retarget", "export"}) {
    const auto& options = command(name).options;
    EXPECT_EQ(command(name).name, name);
    for (const char* read : {"motion", "source-map", "times", "markers", "map", "style", "weights",
                             "engine-weights", "extractor-weights", "camera"})
      EXPECT_EQ(options.at(read).path, Path::Read) << read;
    for (const char* written : {"out", "report", "preview"})
      EXPECT_EQ(options.at(written).path, Path::Written) << written;
    for (const char* neither : {"fps", "format", "person", "engine", "canvas"})
      EXPECT_EQ(options.at(neither).path, Path::None) << neither;
  }
  EXPECT_EQ(command("retarget").options.at("skeletons").path, Path::Written);
}

TEST(BatchCommands, KnowFlagsByEachOfTheirNames) {
  const auto& options = command("export").options;
  for (const char* flag : {"no-lock-feet", "no-foot-lock", "no-offsets", "remove-floor", "use-anyway",
                           "in-place", "root-motion", "no-root-motion", "all-takes", "as-scan"})
    EXPECT_TRUE(options.at(flag).is_flag) << flag;
  for (const char* other : {"fps", "crop", "betas", "rest-pose", "take", "turn", "yaw"})
    EXPECT_FALSE(options.at(other).is_flag) << other;
}

TEST(BatchCommands, LeaveOutWhatALineSaysElsewhereAndWhatNeverEnds) {
  for (const char* name : {"source", "target", "help", "follow", "print-map"})
    EXPECT_EQ(command("export").options.count(name), 0u) << name;
  EXPECT_FALSE(command("retarget").takes_many);
  EXPECT_TRUE(command("export").takes_many);
}

}  // namespace
}  // namespace understudy::app
