#include "retarget/keypoints/track_edits.hpp"

#include <gtest/gtest.h>

#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

/// The same pose in each frame.
std::vector<CleanPose> still_track(size_t frames) {
  CleanPose clean;
  clean.pose = flat_person();
  clean.pose.left_hand = FlatPoints::Ones(kHandPoints, 3);
  return std::vector<CleanPose>(frames, clean);
}

TEST(TrackEdits, ADraggedPointIsThereAndThoseAroundItFollowLessAndLess) {
  std::vector<CleanPose> clean = still_track(9);
  const Vec2 before = clean[4].pose.at(body25::LeftWrist), place = before + Vec2(40, -30);
  edit_track({PointDrag{4, body25::LeftWrist, place.x(), place.y(), 2}}, clean);
  const auto moved = [&](size_t t) { return (clean[t].pose.at(body25::LeftWrist) - before).norm(); };
  EXPECT_NEAR(moved(4), 50, 1e-3f);
  EXPECT_EQ(clean[4].pose.confidence(body25::LeftWrist), 1);
  EXPECT_LT(moved(3), moved(4));
  EXPECT_LT(moved(2), moved(3));
  EXPECT_FLOAT_EQ(moved(3), moved(5));
  EXPECT_EQ(moved(1), 0);
  EXPECT_EQ(clean[4].pose.at(body25::LeftElbow), flat_person().at(body25::LeftElbow));
  EXPECT_FLOAT_EQ(clean[4].pose.left_hand(3, 0), 1 + 40) << "its hand goes along";
}

TEST(TrackEdits, TheFaceGoesWithTheNose) {
  std::vector<CleanPose> clean = still_track(1);
  const Vec2 eye = clean[0].pose.at(body25::LeftEye), nose = clean[0].pose.at(body25::Nose);
  edit_track({PointDrag{0, body25::Nose, nose.x() + 5, nose.y(), 0}}, clean);
  EXPECT_EQ(clean[0].pose.at(body25::LeftEye), eye + Vec2(5, 0));
}

TEST(TrackEdits, APointThatIsMissingIsPutIntoItsOwnFrameAlone) {
  std::vector<CleanPose> clean = still_track(3);
  for (CleanPose& one : clean) one.pose.forget(body25::RightKnee);
  edit_track({PointDrag{1, body25::RightKnee, 30, 40, 5}}, clean);
  EXPECT_EQ(clean[1].pose.at(body25::RightKnee), Vec2(30, 40));
  EXPECT_FALSE(clean[0].pose.has(body25::RightKnee) || clean[2].pose.has(body25::RightKnee));
}

TEST(TrackEdits, BeyondTheTrackAndBeforeAnybodyNothingHappens) {
  std::vector<CleanPose> clean(2);
  edit_track({PointDrag{1, body25::Nose, 30, 40, 5}, PointDrag{9, body25::Nose, 1, 1, 5}}, clean);
  EXPECT_TRUE(is_nobody(clean[1].pose));
}

TEST(TrackEdits, SidesAreExchangedInTheRangeAlone) {
  std::vector<CleanPose> clean = still_track(5);
  edit_track({SidesExchange{1, 3, SidesExchange::Limbs::Legs}}, clean);
  const FlatPose plain = clean[0].pose;
  EXPECT_EQ(clean[2].pose.at(body25::LeftKnee), plain.at(body25::RightKnee));
  EXPECT_EQ(clean[2].pose.at(body25::LeftWrist), plain.at(body25::LeftWrist));
  EXPECT_EQ(clean[4].pose, plain);
  edit_track({SidesExchange{1, 3, SidesExchange::Limbs::Legs}}, clean);
  EXPECT_EQ(clean[2].pose, plain);
  edit_track({SidesExchange{4, 40, SidesExchange::Limbs::Both}, SidesExchange{9, 9}}, clean);
  EXPECT_EQ(clean[4].pose.at(body25::LeftEar), plain.at(body25::RightEar))
      << "beyond the track nothing happens";
}

TEST(TrackEdits, AnExchangeAndADragAreDoneInTheirOrder) {
  const SidesExchange exchange{0, 0, SidesExchange::Limbs::Both};
  const PointDrag drag{0, body25::LeftWrist, 11, 12, 0};
  std::vector<CleanPose> clean = still_track(1);
  edit_track({drag, exchange}, clean);
  EXPECT_EQ(clean[0].pose.at(body25::RightWrist), Vec2(11, 12));
  clean = still_track(1);
  edit_track({exchange, drag}, clean);
  EXPECT_EQ(clean[0].pose.at(body25::LeftWrist), Vec2(11, 12));
}

/// A person in whose frames 10 to 13 a detector took left for right.
KeypointReading detected_track() {
  KeypointReading reading;
  reading.tracks.resize(1);
  for (int t = 0; t < 30; ++t) {
    reading.frames.push_back({t, ""});
    const FlatPose pose = flat_person(100 + 2 * static_cast<float>(t));
    reading.tracks[0].poses.push_back({t, 1, t >= 10 && t < 14 ? sides_exchanged(pose) : pose});
  }
  return reading;
}

TEST(TrackEdits, WhatTheUserExchangesIsNotPutBackAndOverrulesWhatWas) {
  const KeypointReading reading = detected_track();
  std::vector<CleanPose> clean = clean_track(reading, 0);
  ASSERT_TRUE(clean[11].sides_mended) << "the clean-up mends it, and the user says: wrongly";
  const std::vector<CleanPose> before = clean;
  edit_track({SidesExchange{10, 20}}, clean);
  for (size_t t = 0; t < clean.size(); ++t) {
    const bool is_in = t >= 10 && t <= 20;
    EXPECT_EQ(clean[t].pose, is_in ? sides_exchanged(before[t].pose) : before[t].pose) << t;
    if (is_in) EXPECT_TRUE(clean[t].problem.empty() && !clean[t].sides_mended) << t;
  }
}

}  // namespace
}  // namespace understudy
