// The engine lift.
#include "retarget/pose2d/lift_transfer.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "tests/support/fake_lifter.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

LiftTransfer engine() {
  return LiftTransfer(std::make_unique<FakeLifter>(), false);
}

TEST(LiftTransfer, BonesHaveTheOtherPersonsLengthsAndTheMidHipStays) {
  const FlatPose pose = flat_person();
  Proportions other = lengths_of(pose);
  other.length[flat_bone::LeftForearm] *= 2;
  const FlatPose made = engine().transfer(pose, lengths_of(pose), other);
  EXPECT_EQ(made.at(body25::MidHip), pose.at(body25::MidHip));
  // The mean human of FakeLifter is in T-pose: seen from the front its arms lie across the view.
  EXPECT_NEAR((made.at(body25::LeftWrist) - made.at(body25::LeftElbow)).norm(),
              other.length[flat_bone::LeftForearm], 0.05f * other.length[flat_bone::LeftForearm]);
  EXPECT_GT(made.at(body25::LeftWrist).x(), made.at(body25::LeftShoulder).x());
}

TEST(LiftTransfer, WhatThePictureCutsOffIsMadeUpAndPale) {
  FlatPose cut = flat_person();
  const Proportions lengths = lengths_of(cut);
  for (const int p : {body25::LeftKnee, body25::RightKnee, body25::LeftAnkle, body25::RightAnkle})
    cut.forget(p);
  const FlatPose made = engine().transfer(cut, lengths, lengths);
  for (const int p : {body25::LeftKnee, body25::LeftAnkle, body25::RightAnkle}) {
    ASSERT_TRUE(made.has(p));
    EXPECT_LE(made.confidence(p), 0.3f);
    EXPECT_GT(made.at(p).y(), made.at(body25::MidHip).y());
  }
  EXPECT_EQ(made.confidence(body25::LeftWrist), cut.confidence(body25::LeftWrist));
}

TEST(LiftTransfer, HandsGoWithTheWristAndToesWithTheAnkle) {
  FlatPose pose = flat_person();
  pose.left_hand = FlatPoints::Zero(kHandPoints, 3);
  pose.left_hand.row(0) << pose.at(body25::LeftWrist).x(), pose.at(body25::LeftWrist).y(), 1;
  const FlatPose made = engine().transfer(pose, lengths_of(pose), lengths_of(pose));
  EXPECT_LT((made.left_hand.row(0).head<2>().transpose() - made.at(body25::LeftWrist)).norm(), 1e-2f);
  const Vec2 toe = made.at(body25::LeftBigToe) - made.at(body25::LeftAnkle);
  EXPECT_LT((toe - (pose.at(body25::LeftBigToe) - pose.at(body25::LeftAnkle))).norm(), 1e-2f);
}

TEST(LiftTransfer, WhatCannotBeLiftedIsRebuiltAndNobodyIsNobody) {
  FlatPose two;
  two.set(body25::Neck, Vec2(10, 20), 1), two.set(body25::Nose, Vec2(10, 5), 1);
  const Proportions lengths = lengths_of(flat_person());
  const FlatPose made = engine().transfer(two, lengths, lengths);
  EXPECT_TRUE(made.has(body25::Nose));
  EXPECT_FALSE(made.has(body25::LeftAnkle));
  EXPECT_TRUE(is_nobody(engine().transfer({}, lengths, lengths)));
  EXPECT_THROW(LiftTransfer(nullptr, true), Error);
}

}  // namespace
}  // namespace understudy
