#include "retarget/pose2d/limb_transfer.hpp"

#include <gtest/gtest.h>

#include "retarget/metrics/keypoint_metrics.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

Proportions long_arms(const Proportions& of) {
  Proportions lengths = of;
  for (const int b :
       {flat_bone::RightUpperArm, flat_bone::LeftUpperArm, flat_bone::RightForearm, flat_bone::LeftForearm})
    lengths.length[b] *= 1.4f;
  return lengths;
}

TEST(LimbTransfer, OfOnePersonOntoTheSameIsTheSamePose) {
  const FlatPose person = flat_person();
  const Proportions lengths = lengths_of(person);
  const FlatPose made = LimbTransfer(true).transfer(person, lengths, lengths);
  EXPECT_LT((made.body - person.body).cwiseAbs().maxCoeff(), 1e-3f);
}

TEST(LimbTransfer, BonesAreAsLongAsTheTargetsAndPointWhereTheSourcesDo) {
  const FlatPose person = flat_person();
  const Proportions lengths = lengths_of(person), other = long_arms(lengths);
  const FlatPose made = LimbTransfer(false).transfer(person, lengths, other);
  EXPECT_LT((seen_lengths(made) - other.length).abs().maxCoeff(), 1e-2f);
  EXPECT_NEAR(bone_angle_error(made, person), 0, 1e-4);
  EXPECT_EQ(made.at(body25::MidHip), person.at(body25::MidHip));
}

TEST(LimbTransfer, HandsFaceAndFeetRideAlong) {
  FlatPose person = flat_person();
  person.right_hand = FlatPoints::Zero(kHandPoints, 3);
  person.right_hand.row(0) << person.at(body25::RightWrist).x(), person.at(body25::RightWrist).y(), 1;
  person.right_hand.row(8) << person.at(body25::RightWrist).x() - 4, person.at(body25::RightWrist).y() + 10,
      1;
  Proportions lengths = lengths_of(person), other = long_arms(lengths);
  other.length[flat_bone::RightShin] *= 2;
  other.length[flat_bone::RightThigh] *= 2;
  const FlatPose made = LimbTransfer(false).transfer(person, lengths, other);
  const Vec2 finger = made.right_hand.row(8).head<2>().transpose() - made.at(body25::RightWrist);
  EXPECT_LT((finger - 1.4f * Vec2(-4, 10)).norm(), 1e-2f);
  EXPECT_FLOAT_EQ(made.right_hand(3, 2), 0);  // missing stays missing
  const Vec2 toe = made.at(body25::RightBigToe) - made.at(body25::RightAnkle),
             was = person.at(body25::RightBigToe) - person.at(body25::RightAnkle);
  EXPECT_LT((toe - 2 * was).norm(), 1e-2f);
}

TEST(LimbTransfer, WhatIsMissingIsMissingAndWhatHangsOnItIsNot) {
  FlatPose person = flat_person();
  person.forget(body25::RightElbow);
  person.forget(body25::MidHip), person.forget(body25::LeftHip), person.forget(body25::RightHip);
  Proportions lengths = lengths_of(flat_person());
  const FlatPose made = LimbTransfer(true).transfer(person, lengths, long_arms(lengths));
  EXPECT_FALSE(made.has(body25::RightElbow));
  EXPECT_FALSE(made.has(body25::MidHip));
  EXPECT_TRUE(made.has(body25::RightWrist));
  EXPECT_EQ(made.at(body25::Neck), person.at(body25::Neck));
  const Vec2 way = made.at(body25::RightWrist) - made.at(body25::RightShoulder),
             was = person.at(body25::RightWrist) - person.at(body25::RightShoulder);
  EXPECT_LT((way - 1.4f * was).norm(), 0.1f);
}

TEST(LimbTransfer, NobodyStaysNobody) {
  const Proportions lengths = lengths_of(flat_person());
  EXPECT_TRUE(is_nobody(LimbTransfer(true).transfer(FlatPose(), lengths, lengths)));
}

FlatPose hands_on_hips() {
  FlatPose person = flat_person();
  person.set(body25::RightElbow, person.at(body25::RightShoulder) + Vec2(-35, 50), 1);
  person.set(body25::RightWrist, person.at(body25::RightHip) + Vec2(-8, -2), 1);
  person.set(body25::LeftElbow, person.at(body25::LeftShoulder) + Vec2(35, 50), 1);
  person.set(body25::LeftWrist, person.at(body25::LeftHip) + Vec2(8, -2), 1);
  return person;
}

TEST(Touches, AHandOnTheHipStaysThereOnLongArms) {
  const FlatPose person = hands_on_hips();
  const Proportions lengths = lengths_of(person), other = long_arms(lengths);
  const FlatPose apart = LimbTransfer(false).transfer(person, lengths, other),
                 made = LimbTransfer(true).transfer(person, lengths, other);
  const double stature = static_cast<double>(stature_of(lengths.length));
  EXPECT_EQ(touches_kept(apart, stature, person, stature).kept, 0);
  const Touches touches = touches_kept(made, stature, person, stature);
  EXPECT_GE(touches.near, 2);
  EXPECT_EQ(touches.kept, touches.near);
  EXPECT_TRUE((seen_lengths(made) <= other.length + 1e-2f).all());
  // Elbows stay outside.
  EXPECT_LT(made.at(body25::RightElbow).x(), made.at(body25::RightShoulder).x());
  EXPECT_GT(made.at(body25::LeftElbow).x(), made.at(body25::LeftShoulder).x());
}

TEST(Touches, HandsThatMeetBeforeTheChestMeetOnWideShoulders) {
  FlatPose person = flat_person();
  for (const bool right : {true, false}) {
    const float s = right ? -1.0f : 1.0f;
    person.set(right ? body25::RightElbow : body25::LeftElbow, Vec2(300 + 50 * s, 190), 1);
    person.set(right ? body25::RightWrist : body25::LeftWrist, Vec2(300 + 3 * s, 180), 1);
  }
  const Proportions lengths = lengths_of(person);
  Proportions other = lengths;
  for (const int b : {flat_bone::RightShoulder, flat_bone::LeftShoulder}) other.length[b] *= 1.8f;
  const FlatPose made = LimbTransfer(true).transfer(person, lengths, other);
  EXPECT_LT((made.at(body25::RightWrist) - made.at(body25::LeftWrist)).norm(), 12);
}

TEST(Touches, AHandThatLeavesIsLetGoWithoutAJump) {
  const FlatPose start = hands_on_hips();
  const Proportions lengths = lengths_of(start), other = long_arms(lengths);
  FlatPose before;
  for (int t = 0; t <= 60; ++t) {
    FlatPose person = start;
    const float far = static_cast<float>(t);
    person.set(body25::RightWrist, start.at(body25::RightWrist) + Vec2(-far, 0), 1);
    person.set(body25::RightElbow, start.at(body25::RightElbow) + Vec2(-far / 2, 0), 1);
    const FlatPose made = LimbTransfer(true).transfer(person, lengths, other);
    if (t > 0) EXPECT_LT((made.at(body25::RightWrist) - before.at(body25::RightWrist)).norm(), 12) << t;
    before = made;
  }
}

}  // namespace
}  // namespace understudy
