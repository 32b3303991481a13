#include "retarget/pose2d/flat_retargeter.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/pose2d/limb_transfer.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

CleanPose clean(const FlatPose& pose) {
  CleanPose out;
  out.pose = pose;
  return out;
}

FlatPose moved(FlatPose pose, float right, float down) {
  move_pose({right, down}, pose);
  return pose;
}

FlatRetargeter retargeter_of(const FlatTarget& target, FlatPlace place = FlatPlace::Reference) {
  return {std::make_unique<LimbTransfer>(), target, place};
}

float feet_of(const FlatPose& pose) {
  return box_of(pose).max().y();
}

/// Twice as large, in the right half of a picture.
FlatTarget large_one() {
  const FlatPose standing = moved(flat_person(800, 2), 0, 300);
  return {lengths_of(standing), standing, {1600, 900}, {}};
}

TEST(FlatRetargeter, StartsWhereTheTargetStandsAndGoesAsFarAsItsLegsGo) {
  const FlatTarget target = large_one();
  FlatRetargeter retargeter = retargeter_of(target);
  const Proportions source = lengths_of(flat_person());
  const FlatPose first = retargeter.push(clean(flat_person()), source);
  EXPECT_LT((first.body - target.standing->body).leftCols(2).cwiseAbs().maxCoeff(), 0.5f);
  const FlatPose second = retargeter.push(clean(moved(flat_person(), 30, 10)), source);
  EXPECT_NEAR(second.at(body25::MidHip).x() - first.at(body25::MidHip).x(), 60, 0.5f);
  EXPECT_NEAR(feet_of(second) - feet_of(first), 20, 0.5f);
}

TEST(FlatRetargeter, NothingJumpsWhenTheHipsAreNoLongerSeen) {
  FlatTarget target = large_one();
  target.lengths.length[flat_bone::Trunk] *= 1.4f;
  for (const FlatPlace place : {FlatPlace::Reference, FlatPlace::Source}) {
    FlatRetargeter retargeter = retargeter_of(target, place);
    const Proportions source = lengths_of(flat_person());
    FlatPose cut = flat_person();
    for (int p = body25::MidHip; p <= body25::LeftAnkle; ++p) cut.forget(p);
    for (int p = body25::LeftBigToe; p < kBodyPoints; ++p) cut.forget(p);
    const Vec2 before = retargeter.push(clean(flat_person()), source).at(body25::Nose);
    const FlatPose lost = retargeter.push(clean(cut), source);
    EXPECT_FALSE(lost.has(body25::MidHip));
    EXPECT_LT((lost.at(body25::Nose) - before).norm(), 0.5f);
    EXPECT_LT((retargeter.push(clean(moved(cut, 10, 0)), source).at(body25::Nose) - before).norm(), 40);
    EXPECT_LT((retargeter.push(clean(flat_person()), source).at(body25::Nose) - before).norm(), 0.5f);
  }
}

TEST(FlatRetargeter, NothingJumpsWhenFeetComeIntoThePicture) {
  FlatTarget target = large_one();
  target.lengths.length[flat_bone::RightShin] *= 0.5f;
  target.lengths.length[flat_bone::LeftShin] *= 0.5f;
  for (const FlatPlace place : {FlatPlace::Reference, FlatPlace::Source}) {
    FlatRetargeter retargeter = retargeter_of(target, place);
    const Proportions source = lengths_of(flat_person());
    FlatPose cut = flat_person();
    forget_feet(cut);
    const Vec2 before = retargeter.push(clean(cut), source).at(body25::Nose);
    EXPECT_LT((retargeter.push(clean(flat_person()), source).at(body25::Nose) - before).norm(), 0.5f);
  }
}

TEST(FlatRetargeter, FeetStandOnOneLineWhateverTheLegsAre) {
  FlatTarget target = large_one();
  target.lengths.length[flat_bone::RightShin] *= 0.5f;
  target.lengths.length[flat_bone::LeftShin] *= 0.5f;
  FlatRetargeter retargeter = retargeter_of(target);
  const Proportions source = lengths_of(flat_person());
  const float line = feet_of(retargeter.push(clean(flat_person()), source));
  for (int t = 1; t < 20; ++t) {  // sinks into the knees, feet stand
    FlatPose person = flat_person();
    const Vec2 down(0, 3.0f * static_cast<float>(t));
    for (int p = 0; p <= body25::LeftEar; ++p)
      if (p != body25::RightAnkle && p != body25::LeftAnkle) person.set(p, person.at(p) + down, 1);
    EXPECT_NEAR(feet_of(retargeter.push(clean(person), source)), line, 0.5f) << t;
  }
}

TEST(FlatRetargeter, FeetThatGoOutOfSightMakeNoJump) {
  FlatRetargeter retargeter = retargeter_of(large_one());
  const Proportions source = lengths_of(flat_person());
  const FlatPose first = retargeter.push(clean(flat_person()), source);
  FlatPose cut = flat_person();
  for (int p = 0; p < kBodyPoints; ++p)
    if (cut.has(p) && cut.at(p).y() > 320) cut.forget(p);
  const FlatPose second = retargeter.push(clean(cut), source);
  EXPECT_FALSE(second.has(body25::LeftAnkle));
  EXPECT_LT((second.at(body25::Neck) - first.at(body25::Neck)).norm(), 0.5f);
}

TEST(FlatRetargeter, InTheSourcesPlaceItIsAsTallAsTheSource) {
  FlatRetargeter retargeter = retargeter_of(large_one(), FlatPlace::Source);
  const FlatPose made = retargeter.push(clean(flat_person()), lengths_of(flat_person()));
  EXPECT_LT((made.body - flat_person().body).leftCols(2).cwiseAbs().maxCoeff(), 0.5f);
}

TEST(FlatRetargeter, AFrameThatCannotBeUsedRepeatsTheLastPose) {
  FlatRetargeter retargeter = retargeter_of(large_one());
  const Proportions source = lengths_of(flat_person());
  const FlatPose first = retargeter.push(clean(flat_person()), source);
  CleanPose lost = clean(moved(flat_person(), 90, 0));
  lost.is_usable = false;
  EXPECT_EQ(retargeter.push(lost, source), first);
}

TEST(FlatRetargeter, AReferenceWithoutHipsIsMetAtItsNeck) {
  FlatTarget target = large_one();
  for (const int point : {body25::MidHip, body25::RightHip, body25::LeftHip}) target.standing->forget(point);
  forget_feet(*target.standing);
  FlatRetargeter retargeter = retargeter_of(target);
  const FlatPose made = retargeter.push(clean(flat_person()), lengths_of(flat_person()));
  EXPECT_LT((made.at(body25::Neck) - target.standing->at(body25::Neck)).norm(), 0.01f);
}

TEST(FlatRetargeter, HipsThatGoOutOfSightMakeNoJump) {
  FlatRetargeter retargeter = retargeter_of(large_one());
  const Proportions source = lengths_of(flat_person());
  FlatPose half = moved(flat_person(), 30, 0);
  const FlatPose whole = retargeter.push(clean(half), source);
  for (const int point : {body25::MidHip, body25::RightHip, body25::LeftHip}) half.forget(point);
  EXPECT_LT((retargeter.push(clean(half), source).at(body25::Neck) - whole.at(body25::Neck)).norm(), 0.01f);
  half = moved(half, 10, 0);
  EXPECT_NEAR(retargeter.push(clean(half), source).at(body25::Neck).x() - whole.at(body25::Neck).x(), 20,
              0.1);
}

TEST(FlatRetargeter, GrowthIsKeptOrTakenBack) {
  const FlatTarget target = large_one();
  const Proportions source = lengths_of(flat_person());
  const auto height_of = [](const FlatPose& pose) { return box_of(pose).sizes().y(); };
  FlatRetargeter keeps = retargeter_of(target), loses = retargeter_of(target);
  const float before = height_of(keeps.push(clean(flat_person()), source));
  loses.push(clean(flat_person()), source);
  const FlatPose nearer = flat_person(300, 1.5f);
  EXPECT_NEAR(height_of(keeps.push(clean(nearer), source)), 1.5f * before, 1);
  const FlatPose same = loses.push(clean(nearer), source, 1.5f);
  EXPECT_NEAR(height_of(same), before, 1);
  EXPECT_NEAR(feet_of(same), feet_of(*target.standing), 1);  // the floor is where it was
  EXPECT_THROW(loses.push(clean(nearer), source, 0), Error);
}

TEST(FlatRetargeter, ABoneWithoutLengthIsRefused) {
  FlatTarget target = large_one();
  target.lengths.length[flat_bone::Head] = 0;
  EXPECT_THROW(retargeter_of(target), Error);
}

}  // namespace
}  // namespace understudy
