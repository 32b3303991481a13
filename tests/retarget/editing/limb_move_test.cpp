#include "retarget/editing/limb_move.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

struct LimbStage {
  EditedBody body{builtin_joints(), {}};
  Motion walk = builtin_motion("walk", body.rest);
  PoseEdits edits{};

  void move(const LimbMove& move) {
    add_limb_move(move, walk.poses[static_cast<size_t>(move.frame)], body.rest, edits);
  }
  PosedSkeleton before(size_t frame) const { return forward_kinematics(body.rest, walk.poses[frame]); }
  PosedSkeleton after(size_t frame) const {
    return forward_kinematics(body.rest, apply_poses(edits, walk, body).poses[frame]);
  }
  Vec3 moved(size_t frame, int joint) const {
    return (after(frame).joints.row(joint) - before(frame).joints.row(joint)).transpose();
  }
};

TEST(LimbMove, BringsTheHandThereAndTheFramesAroundPartOfTheWay) {
  LimbStage stage;
  const Vec3 offset(0.03f, 0.12f, 0.08f);
  stage.move({30, LeftWrist, offset, 5});
  EXPECT_LT((stage.moved(30, LeftWrist) - offset).norm(), 3e-3f);
  EXPECT_GT(stage.moved(33, LeftWrist).norm(), 0.3f * offset.norm());
  EXPECT_LT(stage.moved(33, LeftWrist).norm(), 0.7f * offset.norm());
  EXPECT_LT(stage.moved(36, LeftWrist).norm(), 1e-5f);
  EXPECT_LT(stage.moved(24, LeftWrist).norm(), 1e-5f);
}

TEST(LimbMove, LeavesTheRestOfTheBodyAndTheHandsRotation) {
  LimbStage stage;
  stage.move({30, RightWrist, Vec3(0, 0.15f, 0.05f), 5});
  for (const int j : {Pelvis, Head, LeftWrist, RightShoulder, LeftFoot, RightFoot})
    EXPECT_LT(stage.moved(30, j).norm(), 1e-5f) << j;
  EXPECT_LT(geodesic_angle(stage.before(30).global[RightWrist], stage.after(30).global[RightWrist]), 2e-3f);
  EXPECT_GT(stage.moved(30, RightElbow).norm(), 0.01f);
}

TEST(LimbMove, OfAFootsBallTakesTheWholeFoot) {
  LimbStage stage;
  const Vec3 offset(0, 0.1f, 0.06f);
  stage.move({12, LeftFoot, offset, 3});
  EXPECT_LT((stage.moved(12, LeftAnkle) - offset).norm(), 3e-3f);
  EXPECT_LT((stage.moved(12, LeftFoot) - offset).norm(), 3e-3f);
}

TEST(LimbMove, GoesNoFurtherThanTheArmReaches) {
  LimbStage stage;
  stage.move({30, LeftWrist, Vec3(2, 0, 0), 0});
  const Joints now = stage.after(30).joints, rest = stage.body.rest;
  const float arm = (rest.row(LeftElbow) - rest.row(LeftShoulder)).norm() +
                    (rest.row(LeftWrist) - rest.row(LeftElbow)).norm();
  const float reached = (now.row(LeftWrist) - now.row(LeftShoulder)).norm();
  EXPECT_GT(reached, 0.98f * arm);
  EXPECT_LT(reached, 1.0001f * arm);
}

TEST(LimbMove, IsOfTheResultAsItIsTurnedAndEditedBefore) {
  LimbStage stage;
  stage.edits.turn = TurnEdit{70};
  stage.edits.rotate = {{28, LeftShoulder, Vec3(0, 0.3f, 0), 6}};
  const Joints before = stage.after(30).joints;
  const Vec3 offset(0.1f, 0.05f, 0);
  stage.move({30, LeftWrist, offset, 5});
  const Vec3 moved = (stage.after(30).joints.row(LeftWrist) - before.row(LeftWrist)).transpose();
  EXPECT_LT((moved - offset).norm(), 3e-3f);
}

TEST(LimbMove, ASecondDragOfTheSameFrameContinuesTheFirst) {
  LimbStage stage;
  stage.move({30, LeftWrist, Vec3(0, 0.08f, 0), 5});
  const size_t edits = stage.edits.rotate.size();
  EXPECT_LE(edits, 3u);
  stage.move({30, LeftWrist, Vec3(0.05f, 0, 0.05f), 5});
  EXPECT_EQ(stage.edits.rotate.size(), edits);
  EXPECT_LT((stage.moved(30, LeftWrist) - Vec3(0.05f, 0.08f, 0.05f)).norm(), 4e-3f);
  stage.move({30, LeftWrist, Vec3(0.05f, 0, 0), 2});  // of another reach: on its own
  EXPECT_GT(stage.edits.rotate.size(), edits);
}

TEST(LimbMove, KnowsItsRotationsAndLeavesThoseOfABoneTurnedByItself) {
  LimbStage stage;
  const Vec3 turn(0, 0.3f, 0);
  stage.edits.rotate = {{30, LeftElbow, turn, 5}};
  stage.move({30, LeftWrist, Vec3(0, 0.08f, 0), 5});
  EXPECT_EQ(stage.edits.rotate[0].axis_angle, turn);
  EXPECT_FALSE(stage.edits.rotate[0].limb);
  ASSERT_GT(stage.edits.rotate.size(), 1u);
  for (size_t i = 1; i < stage.edits.rotate.size(); ++i)
    EXPECT_EQ(stage.edits.rotate[i].limb, LeftWrist) << i;
  EXPECT_EQ(limb_end_label(LeftFoot), "left foot");
  EXPECT_EQ(limb_end_label(RightWrist), "right hand");
}

TEST(LimbMove, IsOfHandsAndFeetAlone) {
  LimbStage stage;
  EXPECT_EQ(limb_end(RightFoot), RightAnkle);
  EXPECT_EQ(limb_end(LeftWrist), LeftWrist);
  EXPECT_EQ(limb_end(LeftKnee), -1);
  EXPECT_EQ(limb_end(-1), -1);
  EXPECT_THROW(stage.move({30, LeftElbow, Vec3::UnitX(), 5}), Error);
  EXPECT_THROW(stage.move({30, LeftWrist, Vec3(NAN, 0, 0), 5}), Error);
}

TEST(Standing, AFootThatIsDraggedAwayStandsNoLonger) {
  LimbStage stage;
  stage.walk.standing.assign(stage.walk.poses.size(), Standing{true, true});
  stage.move({30, LeftAnkle, Vec3(0, 0.2f, 0), 2});
  const Motion motion = apply_poses(stage.edits, stage.walk, stage.body);
  EXPECT_FALSE(motion.standing[30][0]);
  EXPECT_TRUE(motion.standing[30][1]);
  EXPECT_TRUE(motion.standing[40][0]);
}

TEST(Standing, PinnedFeetStandWhereTheyAreHeld) {
  LimbStage stage;
  stage.edits.pin = PinEdit{};
  stage.edits.pin->right = false;
  stage.walk.standing.assign(stage.walk.poses.size(), Standing{false, true});
  const Motion motion = apply_poses(stage.edits, stage.walk, stage.body);
  int standing = 0, changed = 0;
  for (const Standing& feet : motion.standing) standing += feet[0], changed += !feet[1];
  EXPECT_EQ(changed, 0);
  EXPECT_GT(standing, 5);
  EXPECT_LT(standing, static_cast<int>(motion.poses.size()));
}

}  // namespace
}  // namespace understudy
