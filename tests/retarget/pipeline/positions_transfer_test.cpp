#include "retarget/pipeline/copy_transfer.hpp"

#include <gtest/gtest.h>

#include "retarget/pipeline/method_table.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

/// The dance as an extractor that sees rotations tells it.
Extraction told(float t) {
  const PosedSkeleton posed = forward_kinematics(human_rest(), dance(t));
  Extraction source = seen(posed.joints);
  source.global = posed.global;
  return source;
}

TEST(PositionsTransfer, SaysWhatCopySaysWhereNoRotationIsSeen) {
  CopyTransfer positions(/*sees_rotations=*/false);
  CopyTransfer copy;
  positions.reset(other_body());
  copy.reset(other_body());
  for (int i = 0; i < 20; ++i) {
    const Extraction all = told(0.1f * static_cast<float>(i));
    const Rotations a = positions.push(all, 0.1f), b = copy.push(seen(all.joints), 0.1f);
    for (int j = 0; j < kJointCount; ++j) EXPECT_EQ(a[j], b[j]) << i << ' ' << kJointNames[j];
  }
}

TEST(PositionsTransfer, CannotTellHowTheHeadIsTurned) {
  const auto engine = engine_named("positions").make();
  CopyTransfer copy;
  engine->reset(human_rest());
  copy.reset(human_rest());
  const Mat3 truth = dance(1).local[Head];
  EXPECT_GT(geodesic_angle(engine->push(told(1), 0.1f)[Head], truth), 0.2f);
  EXPECT_LT(geodesic_angle(copy.push(told(1), 0.1f)[Head], truth), 0.1f);
}

TEST(PositionsTransfer, AlsoOfASkeletonsOwnRotations) {
  CopyTransfer positions(/*sees_rotations=*/false);
  positions.reset(human_rest());
  Extraction source = told(1);
  source.exact = true;
  EXPECT_GT(geodesic_angle(positions.push(source, 0.1f)[Head], dance(1).local[Head]), 0.2f);
}

}  // namespace
}  // namespace understudy
