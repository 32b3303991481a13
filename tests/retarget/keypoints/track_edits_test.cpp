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
  drag_points({PointDrag{4, body25::LeftWrist, place.x(), place.y(), 2}}, clean);
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
  drag_points({PointDrag{0, body25::Nose, nose.x() + 5, nose.y(), 0}}, clean);
  EXPECT_EQ(clean[0].pose.at(body25::LeftEye), eye + Vec2(5, 0));
}

TEST(TrackEdits, APointThatIsMissingIsPutIntoItsOwnFrameAlone) {
  std::vector<CleanPose> clean = still_track(3);
  for (CleanPose& one : clean) one.pose.forget(body25::RightKnee);
  drag_points({PointDrag{1, body25::RightKnee, 30, 40, 5}}, clean);
  EXPECT_EQ(clean[1].pose.at(body25::RightKnee), Vec2(30, 40));
  EXPECT_FALSE(clean[0].pose.has(body25::RightKnee) || clean[2].pose.has(body25::RightKnee));
}

TEST(TrackEdits, BeyondTheTrackAndBeforeAnybodyNothingHappens) {
  std::vector<CleanPose> clean(2);
  drag_points({PointDrag{1, body25::Nose, 30, 40, 5}, PointDrag{9, body25::Nose, 1, 1, 5}}, clean);
  EXPECT_TRUE(is_nobody(clean[1].pose));
}

TEST(TrackEdits, SidesAreExchangedInTheRangeAlone) {
  KeypointTrack track;
  for (int t = 0; t < 5; ++t) track.poses.push_back({t, 1, flat_person()});
  exchange_sides({SidesExchange{1, 3, SidesExchange::Limbs::Legs}}, track);
  const FlatPose plain = flat_person();
  EXPECT_EQ(track.at(2)->at(body25::LeftKnee), plain.at(body25::RightKnee));
  EXPECT_EQ(track.at(2)->at(body25::LeftWrist), plain.at(body25::LeftWrist));
  EXPECT_EQ(*track.at(0), plain);
  EXPECT_EQ(*track.at(4), plain);
  exchange_sides({SidesExchange{1, 3, SidesExchange::Limbs::Legs}}, track);
  EXPECT_EQ(*track.at(2), plain);
}

}  // namespace
}  // namespace understudy
