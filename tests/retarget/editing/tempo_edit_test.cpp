#include "retarget/editing/tempo_edit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

constexpr float kFps = 30;

std::vector<Joints> walking() {
  std::vector<Joints> joints;
  for (const Pose& pose : builtin_motion("walk", human_rest(), kFps).poses)
    joints.push_back(forward_kinematics(human_rest(), pose).joints);
  return joints;
}

/// Stands, moves a hand from t = 1 s to 1.5 s, stands until 3 s.
std::vector<Joints> one_stroke() {
  std::vector<Joints> joints;
  for (int t = 0; t < 90; ++t) {
    Pose pose;
    const float along = std::clamp((static_cast<float>(t) / kFps - 1) / 0.5f, 0.0f, 1.0f);
    pose.local[LeftShoulder] =
        Eigen::AngleAxisf(1.2f * (1 - std::cos(kPi * along)), Vec3::UnitZ()).toRotationMatrix();
    joints.push_back(forward_kinematics(human_rest(), pose).joints);
  }
  return joints;
}

std::vector<int> all_frames(size_t count) {
  std::vector<int> frames(count);
  for (size_t t = 0; t < count; ++t) frames[t] = static_cast<int>(t);
  return frames;
}

TEST(TempoEdit, OnABodyWithShorterLegsTimeIsTheRootOfTheirRatio) {
  EXPECT_NEAR(body_tempo(0.64f, 1), 0.8f, 1e-6f);
  const auto times = tempo_times({}, walking(), kFps, 0.64f);
  for (size_t t = 0; t < times.size(); ++t)
    EXPECT_NEAR(times[t], 0.8 * static_cast<double>(t) / kFps, 1e-4) << t;
}

TEST(TempoEdit, ANumberIsHowManyTimesAsLongItLasts) {
  TempoEdit edit;
  edit.by = TempoBy::Number;
  edit.length = 1.5f;
  EXPECT_NEAR(tempo_times(edit, walking(), kFps, 0.5f)[30], 1.5, 1e-4);
}

TEST(TempoEdit, AnticipationStrokeAndRecoveryLieAroundTheFastestOfTheMovement) {
  const auto phases = movement_phases(one_stroke(), kFps);
  EXPECT_EQ(phases[10], MovementPhase::Rest);
  EXPECT_EQ(phases[37], MovementPhase::Stroke);
  EXPECT_EQ(phases[80], MovementPhase::Rest);
  const auto first = std::find(phases.begin(), phases.end(), MovementPhase::Anticipation);
  ASSERT_NE(first, phases.end());
  EXPECT_LT(first - phases.begin(), 37);
  const auto last = std::find(phases.rbegin(), phases.rend(), MovementPhase::Recovery);
  ASSERT_NE(last, phases.rend());
  EXPECT_GT(phases.rend() - last, 38);
}

TEST(TempoEdit, AShorterStrokeLeavesTheRestsAsLong) {
  TempoEdit edit;
  edit.by = TempoBy::Number;
  edit.stroke = 0.5f;
  const auto times = tempo_times(edit, one_stroke(), kFps, 1);
  EXPECT_NEAR(times[20], 20 / kFps, 0.01);
  EXPECT_LT(times[89], 89 / kFps - 0.1);
  EXPECT_NEAR(times[89] - times[70], 19 / kFps, 0.01);
}

TEST(TempoEdit, MarksShiftWhatLiesBetweenEvenlyAndTheRestAlong) {
  TempoEdit edit;
  edit.by = TempoBy::Number;
  edit.marks = {{30, 0}, {60, 0.5f}};
  const auto times = tempo_times(edit, walking(), kFps, 1);
  EXPECT_NEAR(times[15], 0.5, 1e-5);
  EXPECT_NEAR(times[30], 1, 1e-5);
  EXPECT_NEAR(times[45], 1.75, 1e-5);
  EXPECT_NEAR(times[60], 2.5, 1e-5);
  EXPECT_NEAR(times[65] - times[60], 5 / kFps, 1e-5);
}

TEST(TempoEdit, ATempoThatWouldTurnBackTimeIsRefused) {
  TempoEdit edit;
  edit.marks = {{30, 0}, {40, -2}};
  EXPECT_THROW(tempo_times(edit, walking(), kFps, 1), Error);
  edit.marks = {{30, 0}, {31, 2}};
  EXPECT_THROW(tempo_times(edit, walking(), kFps, 1), Error);
  edit.marks = {{30, 0}, {30, 1}};  // of two on one frame the first counts
  const auto times = tempo_times(edit, walking(), kFps, 1);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  edit.marks.clear();
  edit.by = TempoBy::Number;
  edit.length = 0;
  EXPECT_THROW(tempo_times(edit, walking(), kFps, 1), Error);
}

TEST(TempoEdit, TheSpreadMakesMovementsUnlikeInLengthAndIsTheSameEachTime) {
  TempoEdit edit;
  edit.by = TempoBy::Number;
  edit.spread = 0.1f;
  const auto joints = walking();
  const auto times = tempo_times(edit, joints, kFps, 1);
  EXPECT_EQ(times, tempo_times(edit, joints, kFps, 1));
  double least = 1e9, most = 0;
  for (size_t t = 1; t < times.size(); ++t) {
    EXPECT_GT(times[t], times[t - 1]);
    least = std::min(least, times[t] - times[t - 1]), most = std::max(most, times[t] - times[t - 1]);
  }
  EXPECT_GT(most, 1.02 * least);
}

TEST(TempoEdit, NothingIsCutOffAtTheEnd) {
  for (const float length : {0.3f, 0.81f, 1.0f, 1.234f, 3.0f}) {
    TempoEdit edit;
    edit.by = TempoBy::Number;
    edit.length = length;
    const auto times = tempo_times(edit, walking(), kFps, 1);
    const auto moments = moments_of(all_frames(times.size()), times, kFps);
    EXPECT_EQ(moments.front().before, 0);
    EXPECT_EQ(moments.front().share, 0);
    EXPECT_EQ(moments.back().after, static_cast<int>(times.size()) - 1) << length;
    EXPECT_NEAR(moments.back().share, 1, 1e-4f) << length;
    EXPECT_NEAR(static_cast<double>(moments.size()), times.back() * kFps + 1, 1) << length;
  }
}

TEST(TempoEdit, WhatIsLeftOutTakesNoTime) {
  const std::vector<double> times = {0, 0.1, 0.2, 0.3, 0.4};
  const auto moments = moments_of({0, 1, 4}, times, 10);
  ASSERT_EQ(moments.size(), 3u);
  EXPECT_EQ(moments[1].before, 1);
  EXPECT_EQ(moments[2].after, 4);
  EXPECT_NEAR(moments[2].share, 1, 1e-5f);
  const auto plain = moments_of({0, 1, 4}, {}, 10);
  ASSERT_EQ(plain.size(), 3u);
  EXPECT_EQ(plain[2].before, 4);
}

TEST(LiveTempo, FallsBackInRestsByTheDelayAndCatchesUpInStrokes) {
  LiveTempo tempo(0.3f);
  float most = 0, least_in_stroke = 1;
  const auto joints = one_stroke();
  for (size_t t = 0; t < joints.size(); ++t) {
    const float behind = tempo.push(joints[t], 1 / kFps, 0.7f);
    EXPECT_GE(behind, 0);
    EXPECT_LE(behind, 0.3f);
    most = std::max(most, behind);
    if (t >= 30 && t < 60) least_in_stroke = std::min(least_in_stroke, behind);
  }
  EXPECT_NEAR(most, 0.3f, 1e-4f);
  EXPECT_LT(least_in_stroke, 0.2f);
  int left = 0;
  while (tempo.behind_s() > 0 && left < 100) tempo.finish(1 / kFps), ++left;
  EXPECT_LE(left, 10);
}

}  // namespace
}  // namespace understudy
