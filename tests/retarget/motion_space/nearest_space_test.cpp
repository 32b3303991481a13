#include "retarget/motion_space/nearest_space.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy {
namespace {

class Nearest : public testing::Test {
 protected:
  static Clip clip_of(const Motion& motion) {
    Clip clip{motion, std::vector<int>(motion.poses.size())};
    std::iota(clip.good.begin(), clip.good.end(), 0);
    return clip;
  }
  static const tests::KnownWalk& made(const char* motion) {
    static const tests::KnownWalk walks("walk"), dances("dance");
    return std::string(motion) == "walk" ? walks : dances;
  }
  const tests::KnownWalk &walk = made("walk"), &dance = made("dance");
  NearestSpace space{{clip_of(walk.motion), clip_of(dance.motion)}};
};

TEST_F(Nearest, FindsItsOwnWindowAgainWhereverItIs) {
  for (const int start : {0, 37, 80}) {
    const Completion answer =
        space.complete(tests::turned(dance.question(start, 40, 10, 29), rotation_about_y(-1), Vec3(5, 0, 1)));
    const Motion back = tests::turned(tests::turned(answer.motion, Mat3::Identity(), Vec3(-5, 0, -1)),
                                      rotation_about_y(1), Vec3::Zero());
    for (int t = 0; t < 40; ++t) EXPECT_LT(dance.error(back, start, t), 1e-4) << start << ": " << t;
  }
}

TEST_F(Nearest, FindsItAtAnotherRate) {
  KnownMotion question = dance.question(37, 40, 10, 29);
  KnownMotion faster{{90, {}, {}}, {}, question.rest};  // between 13 of these frames, of which two are known
  for (int t = 0; t <= 3 * 12; ++t) {
    const float at = static_cast<float>(t) / 3;
    const auto frame = static_cast<size_t>(at);
    const Pose* const from = &dance.motion.poses[37 + frame];
    faster.motion.poses.push_back(between(from[0], from[1], at - static_cast<float>(frame)));
    faster.known.push_back(all_parts(t < 2 || t > 34));
  }
  const std::vector<Pose> truth = faster.motion.poses;
  for (int t = 2; t <= 34; ++t) faster.motion.poses[t] = Pose();
  const Completion answer = space.complete(faster);
  Motion true_motion{90, truth, {}};
  EXPECT_LT(tests::farthest(question.rest, answer.motion, true_motion), 2e-3f);
}

TEST_F(Nearest, FindsItInTheMirror) {
  const Completion answer = space.complete(tests::mirrored(walk.question(13, 30, 10, 19)));
  const Motion back = tests::mirrored(answer.motion);
  for (int t = 0; t < 30; ++t) EXPECT_LT(walk.error(back, 13, t), 1e-4) << t;
}

TEST_F(Nearest, FillsEachGapAndPredicts) {
  KnownMotion question = walk.question(0, 90, 80, 89);
  for (int t = 20; t < 35; ++t) question.known[t] = all_parts(false);
  for (int t = 50; t < 70; ++t) question.known[t] = all_parts(false);
  const Completion answer = space.complete(question);
  for (int t = 0; t < 90; ++t) EXPECT_LT(walk.error(answer.motion, 0, t), 1e-4) << t;
}

TEST_F(Nearest, IsBentThroughBothEnds) {
  KnownMotion question = walk.question(30, 30, 10, 19);
  const Vec3 turn(0, 0.2f, 0);
  for (int t = 0; t < 30; ++t) {
    Pose& pose = question.motion.poses[t];
    pose.local[LeftElbow] = rotation_from_axis_angle(t < 10 ? turn : Vec3(3 * turn)) * pose.local[LeftElbow];
    if (t >= 20) pose.root.y() += 0.11f;
  }
  Clip only = clip_of(walk.motion);  // the very window: walks repeat themselves
  only.good = std::vector<int>(30);
  std::iota(only.good.begin(), only.good.end(), 30);
  const Completion answer = NearestSpace({only}).complete(question);
  for (int t = 10; t < 20; ++t) {
    const float share = static_cast<float>(t - 9) / 11;
    const Pose &pose = answer.motion.poses[t], &truth = walk.motion.poses[30 + t];
    EXPECT_TRUE(pose.local[LeftElbow].isApprox(
        rotation_from_axis_angle((1 + 2 * share) * turn) * truth.local[LeftElbow], 1e-4f))
        << t;
    EXPECT_NEAR(pose.root.y(), truth.root.y() + 0.11f * share, 1e-4f) << t;
  }
}

TEST_F(Nearest, RefusesAGapLongerThanAllClipsAndNoClips) {
  KnownMotion question = dance.question(0, 100, 10, 89);
  question.motion.poses.insert(question.motion.poses.begin() + 20, 200, Pose());
  question.known.insert(question.known.begin() + 20, 200, all_parts(false));
  EXPECT_THROW(space.complete(question), Error);
  EXPECT_THROW(NearestSpace({}), Error);
}

TEST_F(Nearest, SkipsFramesThatAreFlagged) {
  Clip flagged = clip_of(walk.motion);
  flagged.good.erase(flagged.good.begin() + 35);
  const KnownMotion question = walk.question(20, 30, 10, 19);  // frame 35 is in it
  EXPECT_GT(walk.error(NearestSpace({flagged}).complete(question).motion, 20, 15), 1e-3);
}

}  // namespace
}  // namespace understudy
