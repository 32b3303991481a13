// assimp reads what we export as we do.
#include <gtest/gtest.h>

#include "tests/interop/assimp_scene.hpp"
#include "tests/interop/exported.hpp"

namespace understudy::tests {
namespace {

TEST(Assimp, ReadsEveryExportAsWeDo) {
  for (const Exported& exported : all_played()) {
    if (needs_eight(exported)) continue;  // assimp 5.2 reads the first four and says nothing of the others
    AssimpScene scene(exported.path, exported.file);
    ASSERT_EQ(scene.clip_count(), exported.file.animations.size()) << exported.name;
    std::vector<Points> theirs;
    for (const float seconds : exported.times) theirs.push_back(scene.at(exported.clip, seconds));
    const Agreement found = agreement(exported, theirs, 8);
    RecordProperty(exported.name, std::to_string(found.ours_mm));
    EXPECT_LT(found.ours_mm, 0.1) << exported.name;
    EXPECT_LT(found.screen_mm, exported.cost_mm + 0.1) << exported.name;
  }
}

}  // namespace
}  // namespace understudy::tests
