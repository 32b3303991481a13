#include "retarget/pose2d/reference_remarks.hpp"

#include <gtest/gtest.h>

#include "retarget/base/text.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

const Proportions kUsualLengths = lengths_of(flat_person());

std::string remarks_on(const FlatPose& pose, const Proportions& lengths = kUsualLengths) {
  std::string all;
  for (const std::string& remark : reference_remarks(pose, lengths)) append_item(all, remark, "; ");
  return all;
}

FlatPose without_face(FlatPose pose) {
  for (const int point : {body25::Nose, body25::RightEye, body25::LeftEye}) pose.forget(point);
  return pose;
}

FlatPose without_legs(FlatPose pose) {
  for (const int point : {body25::RightKnee, body25::LeftKnee, body25::RightAnkle, body25::LeftAnkle})
    pose.forget(point);
  return pose;
}

/// Nose to the left, legs down, as a detector of people puts it onto a dog seen from the side.
FlatPose dog() {
  FlatPose pose;
  const auto put = [&](int point, float x, float y) { pose.set(point, {x, y}, 0.6f); };
  put(body25::Nose, 60, 170), put(body25::Neck, 100, 200), put(body25::MidHip, 250, 205);
  put(body25::RightShoulder, 98, 201), put(body25::LeftShoulder, 103, 199);
  put(body25::RightElbow, 96, 250), put(body25::LeftElbow, 106, 248);
  put(body25::RightWrist, 95, 320), put(body25::LeftWrist, 104, 318);
  put(body25::RightHip, 248, 206), put(body25::LeftHip, 252, 204);
  put(body25::RightKnee, 262, 255), put(body25::LeftKnee, 240, 252);
  put(body25::RightAnkle, 280, 318), put(body25::LeftAnkle, 262, 320);
  return pose;
}

TEST(ReferenceRemarks, NothingIsSaidOfWhoStandsThere) {
  EXPECT_EQ(remarks_on(flat_person()), "");
  EXPECT_EQ(remarks_on(flat_person(900, 0.3f), lengths_of(flat_person(900, 0.3f))), "");
}

TEST(ReferenceRemarks, ABackIsToldFromExchangedSidesByTheFace) {
  const FlatPose behind = sides_exchanged(flat_person());
  EXPECT_EQ(remarks_on(without_face(behind)).find("is seen from behind"), 0u);
  EXPECT_EQ(remarks_on(behind).find("has left and right exchanged"), 0u);
}

TEST(ReferenceRemarks, OnItsHeadFrontAndBackStayWhatTheyAre) {
  EXPECT_FALSE(is_upside_down(flat_person()));
  const FlatPose turned = turned_by_half(flat_person());
  EXPECT_TRUE(is_upside_down(turned));
  const std::string remarks = remarks_on(turned);
  EXPECT_EQ(remarks.find("is upside down"), 0u) << remarks;
  EXPECT_EQ(turned_by_half(turned), flat_person());
  EXPECT_EQ((seen_lengths(turned) - seen_lengths(flat_person())).abs().maxCoeff(), 0);
}

TEST(ReferenceRemarks, WhoSitsIsToldFromWhoStands) {
  FlatPose front = flat_person(), side = flat_person();
  for (const auto& [knee, ankle] :
       {std::pair{body25::RightKnee, body25::RightAnkle}, std::pair{body25::LeftKnee, body25::LeftAnkle}}) {
    const Vec2 shin = front.at(ankle) - front.at(knee);
    const Vec2 hip = front.at(knee == body25::RightKnee ? body25::RightHip : body25::LeftHip);
    front.set(knee, hip + Vec2(0, 15), 1), front.set(ankle, hip + Vec2(0, 15) + shin, 1);
    side.set(knee, hip + Vec2(80, 5), 1), side.set(ankle, hip + Vec2(80, 5) + shin, 1);
  }
  EXPECT_EQ(remarks_on(front).find("sits"), 0u) << remarks_on(front);
  EXPECT_EQ(remarks_on(side).find("sits"), 0u) << remarks_on(side);
}

TEST(ReferenceRemarks, WithoutLegsTheyAreGuessed) {
  EXPECT_EQ(remarks_on(without_legs(flat_person())).find("shows no legs"), 0u);
  FlatPose one = without_legs(flat_person());
  one.set(body25::LeftKnee, flat_person().at(body25::LeftKnee), 1);
  EXPECT_EQ(remarks_on(one), "");
}

TEST(ReferenceRemarks, ADogIsDoubted) {
  EXPECT_EQ(remarks_on(dog()).find("is on all fours: if that is no person"), 0u) << remarks_on(dog());
}

TEST(ReferenceRemarks, ProportionsThatAreNobodysAreDoubtedWithTheWorstBone) {
  Proportions lengths = kUsualLengths;
  lengths.length[flat_bone::Head] *= 4;
  const std::string remarks = remarks_on(flat_person(), lengths);
  EXPECT_EQ(remarks.find("has proportions that are hardly a person's: head "), 0u) << remarks;
}

TEST(ReferenceRemarks, NobodyAndHalfABodyAreNoTrouble) {
  EXPECT_EQ(remarks_on({}).find("shows no legs"), 0u);
  FlatPose half;
  half.set(body25::RightShoulder, {10, 10}, 1), half.set(body25::RightElbow, {10, 40}, 1);
  EXPECT_EQ(remarks_on(half).find("shows no legs"), 0u);
}

}  // namespace
}  // namespace understudy
