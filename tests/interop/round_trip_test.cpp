// What we export is a character that we take again: the same body, the same rig, the same performance.
#include <gtest/gtest.h>

#include "retarget/character/bone_map.hpp"
#include "tests/interop/exported.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

/// Poses mean the same on both only where both stand alike in their T-pose.
Points performed(const PreparedCharacter& character, const Pose& pose) {
  return RigDeformer(character, nullptr).deform(pose);
}

/// Rows of `values` for every vertex of the parts.
RowMatrix of_parts(const RowMatrix& values, const MergedSurface& surface) {
  RowMatrix out(static_cast<Eigen::Index>(surface.map.size()), values.cols());
  for (size_t v = 0; v < surface.map.size(); ++v)
    out.row(static_cast<Eigen::Index>(v)) = values.row(surface.map[v]);
  return out;
}

TEST(RoundTrip, OurFileIsTheSameTargetAgain) {
  for (const Exported& exported : all_exported()) {
    const PreparedCharacter again = prepare_character(exported.file, nullptr, nullptr);
    ASSERT_TRUE(again.rigged) << exported.name;
    EXPECT_GE(again.map.count(), 20) << exported.name << "\n" << to_table(again.map, exported.file);
    const PreparedCharacter& before = *exported.prepared;
    // Limbs of what came without bones are left up to four degrees off the T-pose, those of bones are not.
    const float most_mm = before.rigged ? 1 : 60;
    EXPECT_LT(1000 * (again.target.joints - before.target.joints).rowwise().norm().maxCoeff(), most_mm)
        << exported.name;
    EXPECT_LT(largest_mm(of_parts(again.target.mesh.vertices, again.surface),
                         of_parts(before.target.mesh.vertices, before.surface)),
              most_mm)
        << exported.name;
    // As it was bound it is the same.
    EXPECT_LT(largest_mm(of_parts(again.surface.mesh.vertices, again.surface),
                         of_parts(before.surface.mesh.vertices, before.surface)),
              1)
        << exported.name;
    // What the file was bound with: its own skin where it had one, else what the screen deformed with, of
    // which the largest four or eight are kept.
    const RowMatrix bound = of_parts(again.weights, again.surface);
    if (before.rigged && exported.options.their_rig)
      EXPECT_LT((bound - of_parts(before.weights, before.surface)).cwiseAbs().maxCoeff(), 1 / 255.0f)
          << exported.name;
    for (const Pose& pose : made_motion(5, before.target.joints)) {
      if (!before.rigged || !exported.options.their_rig) continue;
      EXPECT_LT(largest_mm(of_parts(performed(again, pose), again.surface),
                           of_parts(performed(before, pose), before.surface)),
                1)
          << exported.name;
    }
  }
}

TEST(RoundTrip, PerformingTheSameMotionAgainWritesTheSameAnimation) {
  for (const Exported& exported : all_exported()) {
    const PreparedCharacter again = prepare_character(exported.file, nullptr, nullptr);
    const RigDeformer screen(again, nullptr);
    for (size_t t = 0; t < kFramesShown; ++t) {
      const Points now = of_parts(screen.deform(exported.poses[t]), again.surface);
      const Points then = exported.ours_at(exported.times[t]);
      // Shapes are no part of the rig: they are what the networks add to it on the screen.
      if (exported.options.shapes > 0) continue;
      EXPECT_LT(largest_mm(now, then), 1 + exported.options.reduce_mm) << exported.name << " at " << t;
    }
  }
}

}  // namespace
}  // namespace understudy::tests
