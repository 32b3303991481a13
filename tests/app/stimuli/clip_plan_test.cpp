// What a clip shows when.
#include "app/stimuli/clip_plan.hpp"

#include <gtest/gtest.h>

#include <string>

namespace understudy::app {
namespace {

StudyClip clip_of(float seconds, float card_s = 1, float speed = 1) {
  StudyClip clip;
  clip.seconds = seconds, clip.card_s = card_s, clip.speed = speed;
  return clip;
}

/// "mmm-mmm": a letter a frame, '-' a card.
std::string shown(const ClipPlan& plan) {
  std::string text;
  for (int i = 0; i < plan.frames(); ++i) text += plan.at(i).is_card ? '-' : 'm';
  return text;
}

TEST(ClipPlan, CutsALongMotion) {
  const ClipPlan plan(clip_of(10), 30, 12.5);
  EXPECT_EQ(plan.frames(), 300);
  EXPECT_EQ(plan.runs(), 1);
  EXPECT_EQ(shown(plan), std::string(300, 'm'));
  EXPECT_DOUBLE_EQ(plan.at(299).motion_s, 299.0 / 30);
}

TEST(ClipPlan, RepeatsAShortMotionWithACardBetween) {
  const ClipPlan plan(clip_of(10), 30, 2.9);
  EXPECT_EQ(plan.frames(), 300);
  EXPECT_EQ(plan.runs(), 3);
  const std::string run(87, 'm'), card(30, '-');
  EXPECT_EQ(shown(plan), run + card + run + card + std::string(66, 'm'));
  EXPECT_DOUBLE_EQ(plan.at(117).motion_s, 0);
  EXPECT_DOUBLE_EQ(plan.at(120).motion_s, 0.1);
}

TEST(ClipPlan, ShowsNoCardThatNothingFollows) {
  const ClipPlan plan(clip_of(10), 10, 9.2);
  EXPECT_EQ(plan.runs(), 1);
  EXPECT_EQ(shown(plan), std::string(100, 'm'));
  EXPECT_DOUBLE_EQ(plan.at(99).motion_s, 9.1) << "the last picture stays";
  EXPECT_EQ(ClipPlan(clip_of(10), 10, 8.5).runs(), 2) << "half a second is left";
}

TEST(ClipPlan, HasNoCardWhereItTakesNoTime) {
  const ClipPlan plan(clip_of(1, 0), 10, 0.4);
  EXPECT_EQ(plan.runs(), 3);
  EXPECT_EQ(shown(plan), std::string(10, 'm'));
  EXPECT_DOUBLE_EQ(plan.at(4).motion_s, 0);
}

TEST(ClipPlan, HalfTheSpeedTakesTwiceAsLong) {
  const ClipPlan plan(clip_of(10, 1, 0.5f), 30, 2);
  EXPECT_EQ(shown(plan).find('-'), 120u);
  EXPECT_DOUBLE_EQ(plan.at(60).motion_s, 1);
}

TEST(ClipPlan, AMotionShorterThanAFrameIsShown) {
  const ClipPlan plan(clip_of(1, 0.2f), 10, 0.01);
  EXPECT_FALSE(plan.at(0).is_card);
  EXPECT_EQ(plan.at(0).motion_s, 0);
  EXPECT_EQ(plan.frames(), 10);
}

}  // namespace
}  // namespace understudy::app
