#include "retarget/keypoints/keypoint_filter.hpp"

#include <cmath>

#include "retarget/base/rng.hpp"
#include "retarget/keypoints/exchanged_sides.hpp"
#include "tests/retarget/keypoints/support.hpp"

namespace understudy {
namespace {

using namespace test;

constexpr float kTall = 300;

/// Waves an arm, walks sideways.
FlatPose dancer(int frame) {
  const float t = static_cast<float>(frame) / 30;
  FlatPose pose = standing({200 + 60 * t, 400}, kTall, 1);
  pose.set(body25::LeftWrist, pose.at(body25::LeftElbow) + 50 * Vec2(std::sin(4 * t), -std::cos(4 * t)), 1);
  return pose;
}
FlatPose shaken(FlatPose pose, Rng& rng, float pixels) {
  for (int p = 0; p < kBodyPoints; ++p)
    pose.set(p, pose.at(p) + pixels * Vec2(rng.normal(), rng.normal()), pose.confidence(p));
  return pose;
}
/// Root mean square distance over points and frames, and mean second difference.
struct Judged {
  double error = 0, jitter = 0;
};
Judged judged(const std::vector<FlatPose>& poses) {
  Judged out;
  int errors = 0, jitters = 0;
  for (int t = 10; t < static_cast<int>(poses.size()); ++t)
    for (int p = 0; p < kBodyPoints; ++p) {
      const auto at = [&](int frame) { return poses[static_cast<size_t>(frame)].at(p); };
      out.error += (at(t) - dancer(t).at(p)).squaredNorm(), ++errors;
      out.jitter += (at(t) - 2 * at(t - 1) + at(t - 2)).norm(), ++jitters;
    }
  return {std::sqrt(out.error / errors), out.jitter / jitters};
}

TEST(KeypointFilter, CalmsJitterAndComesNearerToTheTruth) {
  Rng rng(3);
  KeypointFilter filter;
  std::vector<FlatPose> raw, clean;
  for (int t = 0; t < 200; ++t) {
    raw.push_back(shaken(dancer(t), rng, 0.0086f * kTall));
    clean.push_back(filter.push(&raw.back(), kFrame).pose);
  }
  EXPECT_LT(judged(clean).jitter, 0.35 * judged(raw).jitter);
  EXPECT_LT(judged(clean).error, 0.9 * judged(raw).error);
}

TEST(KeypointFilter, WithoutSmoothingNothingMoves) {
  KeypointFilterOptions options;
  options.smoothing = 0;
  KeypointFilter filter(options);
  for (int t = 0; t < 50; ++t) {
    const FlatPose pose = with_hands_and_face(dancer(t));
    EXPECT_EQ(filter.push(&pose, kFrame).pose, pose);
  }
}

TEST(KeypointFilter, NoPoseDependsOnALaterFrame) {
  Rng rng(5);
  std::vector<FlatPose> seen;
  for (int t = 0; t < 40; ++t) seen.push_back(shaken(dancer(t), rng, 3));
  std::vector<FlatPose> other = seen;
  for (int t = 20; t < 40; ++t) other[static_cast<size_t>(t)] = standing({900, 50}, 20);
  KeypointFilter a, b;
  for (size_t t = 0; t < 20; ++t) EXPECT_EQ(a.push(&seen[t], kFrame).pose, b.push(&other[t], kFrame).pose);
}

TEST(KeypointFilter, AMissingPointGoesOnForHalfASecond) {
  KeypointFilter filter;
  for (int t = 0; t < 30; ++t) {
    const FlatPose pose = dancer(t);
    filter.push(&pose, kFrame);
  }
  for (int t = 30; t < 60; ++t) {
    FlatPose pose = dancer(t);
    pose.forget(body25::RightWrist);
    const CleanPose clean = filter.push(&pose, kFrame);
    const bool goes_on = t < 44;
    if (t == 44) continue;  // half a second, but for rounding
    EXPECT_EQ(clean.pose.has(body25::RightWrist), goes_on) << t;
    EXPECT_EQ(clean.points_filled, goes_on ? 1 : 0);
    if (t < 36) {
      EXPECT_LT((clean.pose.at(body25::RightWrist) - dancer(t).at(body25::RightWrist)).norm(), 8) << t;
    }
    if (goes_on) {
      EXPECT_LT(clean.pose.confidence(body25::RightWrist), 1);
    }
  }
}

TEST(KeypointFilter, ExchangedSidesArePutBack) {
  KeypointFilter filter;
  for (int t = 0; t < 40; ++t) {
    FlatPose pose = dancer(t);
    const bool is_exchanged = t >= 20 && t < 25;
    if (is_exchanged) pose = sides_exchanged(pose);
    const CleanPose clean = filter.push(&pose, kFrame);
    EXPECT_EQ(clean.sides_mended, is_exchanged) << t;
    EXPECT_LT(farthest_apart(clean.pose, dancer(t)), 9) << t;
    if (is_exchanged) {
      EXPECT_EQ(clean.problem, "left and right were exchanged and are put back");
    }
  }
}

TEST(KeypointFilter, OnlyTheLegsMayBeExchanged) {
  KeypointFilter filter;
  for (int t = 0; t < 30; ++t) {
    FlatPose pose = dancer(t);
    const FlatPose other = sides_exchanged(pose);
    for (int p = body25::RightHip; t == 20 && p < kBodyPoints; ++p)
      if (p < body25::RightEye || p > body25::LeftEar) pose.body.row(p) = other.body.row(p);
    const CleanPose clean = filter.push(&pose, kFrame);
    EXPECT_EQ(clean.sides_mended, t == 20);
    EXPECT_LT((clean.pose.at(body25::LeftAnkle) - dancer(t).at(body25::LeftAnkle)).norm(), 3);
  }
}

TEST(KeypointFilter, AFirstFrameThatIsWrongIsNotBelievedForEver) {
  KeypointFilter filter;
  for (int t = 0; t < 90; ++t) {
    const FlatPose pose = t < 3 ? sides_exchanged(dancer(t)) : dancer(t);
    const CleanPose clean = filter.push(&pose, kFrame);
    if (t > 40) {
      EXPECT_LT(farthest_apart(clean.pose, dancer(t)), 9) << t;
    }
  }
}

TEST(KeypointFilter, SidesAreBelievedNoLongerThanTheyWereSeen) {
  KeypointFilter filter;
  for (int t = 0; t < 20; ++t) {
    const FlatPose pose = t < 2 ? sides_exchanged(dancer(t)) : dancer(t);
    const CleanPose clean = filter.push(&pose, kFrame);
    if (t > 6) {
      EXPECT_LT(farthest_apart(clean.pose, dancer(t)), 9) << t;
    }
  }
}

TEST(KeypointFilter, LegsThatAreExchangedInTheFirstFrameArePutBack) {
  for (const bool legs : {true, false}) {
    FlatPose pose = dancer(0);
    const FlatPose other = sides_exchanged(pose);
    for (int p = 0; p < kBodyPoints; ++p)
      if (ExchangedSides::is_in_group(p, legs ? 1 : 0)) pose.body.row(p) = other.body.row(p);
    KeypointFilter filter;
    const CleanPose clean = filter.push(&pose, kFrame);
    EXPECT_TRUE(clean.sides_mended);
    EXPECT_LT(farthest_apart(clean.pose, dancer(0)), 1e-3f) << legs;
    for (const int p : {body25::RightEye, body25::LeftEye, body25::RightEar, body25::LeftEar}) pose.forget(p);
    filter.reset();
    EXPECT_FALSE(filter.push(&pose, kFrame).sides_mended) << "nobody can tell which of the two it is";
  }
}

TEST(KeypointFilter, SomebodyWhoTurnsAroundIsNotExchanged) {
  KeypointFilter filter;
  for (int t = 0; t < 60; ++t) {
    const float width = std::cos(kPi * static_cast<float>(t) / 59);  // front, profile, back in two seconds
    FlatPose pose = standing({300, 400}, kTall, 1);
    for (int p = 0; p < kBodyPoints; ++p)
      pose.set(p, {300 + width * (pose.at(p).x() - 300), pose.at(p).y()}, 1);
    EXPECT_FALSE(filter.push(&pose, kFrame).sides_mended) << t;
  }
}

TEST(KeypointFilter, AFrameThatCannotBeUsedRepeatsTheLastPoseAndSaysWhy) {
  KeypointFilter filter;
  EXPECT_TRUE(is_nobody(filter.push(nullptr, kFrame).pose)) << "nobody was seen yet";
  const FlatPose pose = dancer(0);
  const FlatPose shown = filter.push(&pose, kFrame).pose;
  const CleanPose repeated = filter.push(nullptr, kFrame, "x.json: frame 2 is missing");
  EXPECT_FALSE(repeated.is_usable);
  EXPECT_EQ(repeated.pose, shown);
  EXPECT_EQ(repeated.problem, "x.json: frame 2 is missing");
  FlatPose two;
  two.set(body25::Nose, {5, 5}, 1);
  two.set(body25::Neck, {5, 9}, 1);
  EXPECT_EQ(filter.push(&two, kFrame).problem, "only 2 of 25 points are seen");
}

TEST(KeypointFilter, OnePointThatJumpsForAMomentIsNotFollowed) {
  KeypointFilter filter;
  for (int t = 0; t < 40; ++t) {
    FlatPose pose = dancer(t);
    if (t == 20) pose.set(body25::RightKnee, {10, 10}, 1);
    const CleanPose clean = filter.push(&pose, kFrame);
    EXPECT_LT((clean.pose.at(body25::RightKnee) - dancer(t).at(body25::RightKnee)).norm(), 5) << t;
  }
}

TEST(KeypointFilter, ACutIsFollowedAtOnce) {
  KeypointFilter filter;
  for (int t = 0; t < 20; ++t) {
    const FlatPose pose = standing({t < 10 ? 200.0f : 900.0f, 400}, kTall, 1);
    EXPECT_LT(farthest_apart(filter.push(&pose, kFrame).pose, pose), 1) << t;
  }
}

TEST(KeypointFilter, TenThousandFramesEndAsTheyBegan) {
  KeypointFilter filter;
  const FlatPose pose = with_hands_and_face(standing({300, 400}, kTall, 0.8f));
  FlatPose first, last;
  for (int t = 0; t < 10000; ++t) {
    last = filter.push(&pose, kFrame).pose;
    if (t == 0) first = last;
  }
  EXPECT_EQ(first, last);
}

TEST(KeypointFilter, HandsRideAlongAndAreFilledToo) {
  KeypointFilter filter;
  const FlatPose pose = with_hands_and_face(dancer(0));
  filter.push(&pose, kFrame);
  FlatPose without = pose;
  without.left_hand.resize(0, 3);
  EXPECT_EQ(filter.push(&without, kFrame).pose.left_hand.rows(), kHandPoints);
  for (int t = 0; t < 30; ++t) filter.push(&without, kFrame);
  EXPECT_EQ(filter.push(&without, kFrame).pose.left_hand.rows(), 0);
}

TEST(KeypointFilter, RefusesTimesThatDoNotPass) {
  KeypointFilter filter;
  const FlatPose pose = dancer(0);
  EXPECT_TRUE(contains(error_of([&] { filter.push(&pose, 0); }), "must be above 0"));
}

TEST(KeypointFilter, CleansATrackWithItsGapsInTime) {
  std::vector<FlatPose> poses;
  for (int t = 0; t < 20; ++t) poses.push_back(t == 7 ? FlatPose() : dancer(t));
  const KeypointReading reading = reading_of({poses});
  const std::vector<CleanPose> clean = clean_track(reading, 0);
  ASSERT_EQ(clean.size(), 20u);
  EXPECT_EQ(clean[7].problem, "person 1 is not seen in frame 7");
  EXPECT_EQ(clean[7].pose, clean[6].pose);
  EXPECT_LT(farthest_apart(clean[19].pose, dancer(19)), 9);
}

}  // namespace
}  // namespace understudy
