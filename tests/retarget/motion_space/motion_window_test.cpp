#include "retarget/motion_space/motion_window.hpp"

#include <gtest/gtest.h>

#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Known = std::vector<KnownParts>;

Motion turning(int frames, float fps) {
  Motion motion;
  motion.fps = fps;
  for (int t = 0; t < frames; ++t) {
    Pose& pose = motion.poses.emplace_back();
    pose.root = Vec3(0.01f * static_cast<float>(t), 0.9f, 0);
    pose.local[LeftElbow] = rotation_from_axis_angle({0, 0.01f * static_cast<float>(t), 0});
  }
  return motion;
}

Known all_but(int frames, const std::vector<std::array<int, 2>>& gaps) {
  Known known(static_cast<size_t>(frames), all_parts(true));
  for (const auto& [first, last] : gaps)
    for (int t = first; t <= last; ++t) known[t] = all_parts(false);
  return known;
}

std::vector<MotionWindow> windows(int frames, float fps, const std::vector<std::array<int, 2>>& gaps) {
  static const Joints rest = builtin_person().joints;
  return windows_of(all_but(frames, gaps), turning(frames, fps), rest);
}

TEST(MotionWindow, HasAFewKnownSamplesOnEachSideOfAGap) {
  const auto made = windows(100, 30, {{40, 54}});
  ASSERT_EQ(made.size(), 1u);
  const MotionWindow& window = made[0];
  EXPECT_EQ(window.curve.size(), 4u + 15 + 4);
  EXPECT_EQ(window.first, 36);
  EXPECT_EQ(window.gap_frames.size(), 15u);
  EXPECT_EQ(window.gap_frames.front(), 40);
  const std::array<float, 2> none = {0, 0}, first = {1, 15}, last = {15, 1};
  EXPECT_EQ(window.distance[3][kRootPart], none);
  EXPECT_EQ(window.distance[4][kRootPart], first);
  EXPECT_EQ(window.distance[18][LeftKnee], last);
  EXPECT_EQ(window.distance[19][LeftKnee], none);
  EXPECT_LT(window.curve[3].root.norm(), 1e-6f);  // it is looked at from the last known frame
}

TEST(MotionWindow, IsOfThirtySamplesASecondAtAnyRate) {
  for (const float fps : {24.f, 25.f, 50.f, 60.f, 120.f}) {
    const float step = fps / 30;
    const int first = 100, last = first + static_cast<int>(0.5f * fps) - 1;
    const auto made = windows(300, fps, {{first, last}});
    ASSERT_EQ(made.size(), 1u) << fps;
    const MotionWindow& window = made[0];
    EXPECT_NEAR(window.step, step, 1e-5f);
    EXPECT_NEAR(static_cast<float>(window.curve.size()), 4 + 15 + 4, 2) << fps;
    // A sample is the last known frame; each is what the motion is at its moment.
    EXPECT_NEAR(window.first + 3 * step, first - 1, 1e-3f) << fps;
    for (size_t i = 0; i < window.curve.size(); ++i) {
      const float frame = window.first + static_cast<float>(i) * step;
      EXPECT_NEAR(rotation_to_axis_angle(window.curve[i].local[LeftElbow]).y(), 0.01f * frame, 2e-3f) << fps;
      const float since = std::max(0.0f, frame - static_cast<float>(first - 1));
      if (since > 0.01f && frame < static_cast<float>(last))
        EXPECT_NEAR(window.distance[i][Head][0], since / step, 2e-2f) << fps << " " << i;
    }
  }
}

TEST(MotionWindow, GapsThatAreNearShareOne) {
  EXPECT_EQ(windows(100, 30, {{30, 34}, {40, 44}}).size(), 1u);
  EXPECT_EQ(windows(100, 30, {{20, 24}, {60, 64}}).size(), 2u);
  const auto many = windows(300, 30, {{20, 50}, {55, 90}, {95, 125}});
  ASSERT_EQ(many.size(), 2u);  // together they are too long
  for (const MotionWindow& window : many) EXPECT_LE(window.curve.size(), static_cast<size_t>(kLongestWindow));
}

TEST(MotionWindow, ALongGapHasNone) {
  EXPECT_EQ(windows(300, 30, {{100, 201}}).size(), 1u);
  EXPECT_TRUE(windows(300, 30, {{100, 202}}).empty());
  EXPECT_EQ(windows(300, 30, {{100, 202}, {250, 255}}).size(), 1u);
}

TEST(MotionWindow, AtTheEndsTheOtherSideIsSeenFarther) {
  const auto made = windows(100, 30, {{90, 99}});
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].curve.size(), 24u + 10);
  EXPECT_EQ(made[0].distance.back()[Head][1], kFarFrames);
  const auto begin = windows(100, 30, {{0, 9}});
  ASSERT_EQ(begin.size(), 1u);
  EXPECT_EQ(begin[0].curve.size(), 10 + 24u);
  EXPECT_EQ(begin[0].distance.front()[Head][0], kFarFrames);
}

TEST(MotionWindow, SeenInAMirrorTwiceItIsTheSame) {
  const Joints rest = builtin_person().joints;
  Known known = all_but(60, {{20, 29}});
  for (auto& parts : known) parts[LeftWrist] = true;
  const MotionWindow window = windows_of(known, builtin_motion("walk", rest), rest).front();
  const MotionWindow once = mirrored(window), twice = mirrored(once);
  EXPECT_EQ(once.distance[8][RightWrist][0], 0);
  EXPECT_GT(once.distance[8][LeftWrist][0], 0);
  EXPECT_LT((twice.rest - window.rest).cwiseAbs().maxCoeff(), 1e-7f);
  for (size_t i = 0; i < window.curve.size(); ++i) {
    EXPECT_EQ(twice.curve[i].root, window.curve[i].root);
    EXPECT_EQ(twice.curve[i].local, window.curve[i].local);
    EXPECT_EQ(twice.distance[i], window.distance[i]);
  }
}

}  // namespace
}  // namespace understudy
