#include "retarget/editing/skeleton_edits.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

Extraction standing() {
  Extraction seen;
  seen.joints = builtin_joints();
  seen.confidence.setConstant(0.4f);
  seen.global = identity_rotations();
  return seen;
}

Vec3 moved(const Extraction& before, const Extraction& after, int j) {
  return (after.joints.row(j) - before.joints.row(j)).transpose();
}

const Vec3 kUp(0, 0.1f, 0);

TEST(DragEdit, MovesTheJointFullyAtItsFrameAndLessAround) {
  const Extraction seen = standing();
  const std::vector<SkeletonEdit> edits = {DragEdit{10, LeftElbow, kUp, 4, false}};
  float last = 1;
  for (const int away : {0, 1, 2, 3, 4, 5}) {
    const float y = moved(seen, apply(edits, seen, 10 + away), LeftElbow).y();
    EXPECT_NEAR(y, moved(seen, apply(edits, seen, 10 - away), LeftElbow).y(), 1e-6f);
    if (away == 0) {
      EXPECT_NEAR(y, 0.1f, 1e-6f);
    }
    if (away > 0) {
      EXPECT_LT(y, last);
    }
    if (away == 5) {
      EXPECT_EQ(y, 0);
    }
    last = y;
  }
}

TEST(DragEdit, LeavesTheOtherJointsUnlessAskedToTakeTheChildren) {
  const Extraction seen = standing();
  const Extraction alone = apply({DragEdit{0, LeftShoulder, kUp, 0, false}}, seen, 0);
  const Extraction all = apply({DragEdit{0, LeftShoulder, kUp, 0, true}}, seen, 0);
  EXPECT_EQ(moved(seen, alone, LeftElbow).norm(), 0);
  for (const int j : {LeftShoulder, LeftElbow, LeftWrist})
    EXPECT_NEAR((moved(seen, all, j) - kUp).norm(), 0, 1e-6f);
  for (const int j : {LeftCollar, RightShoulder, RightElbow, Head, Neck})
    EXPECT_EQ(moved(seen, all, j).norm(), 0);
}

TEST(DragEdit, OfThePelvisWithChildrenMovesAll) {
  const Extraction seen = standing();
  const Extraction all = apply({DragEdit{0, Pelvis, kUp, 0, true}}, seen, 0);
  for (int j = 0; j < kJointCount; ++j) EXPECT_NEAR(moved(seen, all, j).y(), 0.1f, 1e-6f);
}

TEST(DragEdit, IsBelievedAndTurnsTheSeenBone) {
  const Extraction seen = standing();
  const Extraction after = apply({DragEdit{0, LeftWrist, Vec3(0, 0.2f, 0), 0, false}}, seen, 0);
  EXPECT_EQ(after.confidence[LeftWrist], 1);
  EXPECT_EQ(after.confidence[LeftElbow], 0.4f);
  ASSERT_TRUE(after.global);
  const Vec3 rest_bone = (seen.joints.row(LeftWrist) - seen.joints.row(LeftElbow)).transpose();
  const Vec3 bone = (after.joints.row(LeftWrist) - after.joints.row(LeftElbow)).transpose();
  const Vec3 turned = (*after.global)[LeftElbow] * rest_bone;
  EXPECT_LT(turned.normalized().cross(bone.normalized()).norm(), 1e-4f);
  EXPECT_LT(geodesic_angle((*after.global)[RightElbow], Mat3::Identity()), 1e-6f);
}

TEST(SwapEdit, ExchangesTheLimbsInItsRangeOnly) {
  const Extraction seen = standing();
  const std::vector<SkeletonEdit> arms = {SwapEdit{3, 5, SwapEdit::Limbs::Arms}};
  const Extraction after = apply(arms, seen, 5);
  EXPECT_EQ(after.joints.row(LeftWrist), seen.joints.row(RightWrist));
  EXPECT_EQ(after.joints.row(RightShoulder), seen.joints.row(LeftShoulder));
  EXPECT_EQ(after.joints.row(LeftKnee), seen.joints.row(LeftKnee));
  EXPECT_FALSE(after.global);
  EXPECT_GE(after.confidence[LeftWrist], 0.9f);
  EXPECT_EQ(apply(arms, seen, 6).joints, seen.joints);
  EXPECT_EQ(apply(arms, seen, 2).joints, seen.joints);
  EXPECT_TRUE(apply(arms, seen, 2).global);
}

TEST(SwapEdit, OfBothTwiceGivesBackWhatWas) {
  const Extraction seen = standing();
  const SwapEdit both{0, 9, SwapEdit::Limbs::Both};
  EXPECT_NE(apply({both}, seen, 4).joints, seen.joints);
  EXPECT_EQ(apply({both, both}, seen, 4).joints, seen.joints);
}

TEST(SkeletonEdits, RunInTheirOrder) {
  const Extraction seen = standing();
  const DragEdit drag{0, LeftWrist, kUp, 0, false};
  const SwapEdit swap{0, 0, SwapEdit::Limbs::Arms};
  EXPECT_NEAR(moved(seen, apply({drag, swap}, seen, 0), RightWrist).x(),
              seen.joints(LeftWrist, 0) - seen.joints(RightWrist, 0), 1e-6f);
  EXPECT_NEAR(apply({drag, swap}, seen, 0).joints(RightWrist, 1), seen.joints(LeftWrist, 1) + 0.1f, 1e-6f);
  EXPECT_NEAR(apply({swap, drag}, seen, 0).joints(LeftWrist, 1), seen.joints(RightWrist, 1) + 0.1f, 1e-6f);
}

TEST(SkeletonEdits, RefuseAJointThatIsNone) {
  EXPECT_THROW(apply({DragEdit{0, 22, kUp, 0, false}}, standing(), 0), Error);
  EXPECT_THROW(apply({DragEdit{0, -1, kUp, 0, false}}, standing(), 0), Error);
}

TEST(FalloffWeight, IsOneAtTheFrameAndNothingPastTheReach) {
  EXPECT_EQ(falloff_weight(7, 7, 0), 1);
  EXPECT_EQ(falloff_weight(8, 7, 0), 0);
  EXPECT_GT(falloff_weight(2, 7, 5), 0);
  EXPECT_EQ(falloff_weight(13, 7, 5), 0);
  constexpr int kLast = std::numeric_limits<int>::max();
  EXPECT_EQ(falloff_weight(kLast, -kLast, kLast), 0);  // their difference fits no int
}

}  // namespace
}  // namespace understudy
