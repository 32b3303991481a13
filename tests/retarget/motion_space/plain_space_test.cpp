#include "retarget/motion_space/plain_space.hpp"

#include <gtest/gtest.h>

#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/confidence.hpp"
#include "retarget/motion_space/nearest_space.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy {
namespace {

using tests::KnownWalk;

const KnownWalk& dance() {
  static const KnownWalk made;
  return made;
}

/// Each of them answers the question.
class MotionSpaces : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<MotionSpace> space = made(GetParam());

 private:
  static std::unique_ptr<MotionSpace> made(const std::string& name) {
    if (name == "hold") return make_hold_space();
    if (name == "glide") return make_glide_space();
    if (name == "coast") return make_coast_space();
    if (name == "slerp") return make_slerp_space();
    if (name == "hermite") return make_hermite_space();
    static const KnownWalk walk("walk");
    Clip clip{walk.motion, {}};
    for (size_t t = 0; t < clip.motion.poses.size(); ++t) clip.good.push_back(static_cast<int>(t));
    return std::make_unique<NearestSpace>(std::vector<Clip>{clip});
  }
};
INSTANTIATE_TEST_SUITE_P(All, MotionSpaces,
                         testing::Values("hold", "glide", "coast", "slerp", "hermite", "nearest"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(MotionSpaces, HasItsName) {
  EXPECT_EQ(space->name(), GetParam());
}

TEST_P(MotionSpaces, KeepsWhatIsKnownToTheBitWhateverThatIs) {
  Rng rng(1);
  for (int attempt = 0; attempt < 20; ++attempt) {
    KnownMotion question = dance().question(20, 40, 1, 0);
    for (KnownParts& frame : question.known)
      if (rng.chance(0.6f))
        for (bool& part : frame) part = rng.chance(0.3f);
    const Completion answer = space->complete(question);
    ASSERT_EQ(answer.motion.poses.size(), 40u);
    ASSERT_EQ(answer.doubt_m.size(), 40u);
    for (size_t t = 0; t < 40; ++t) {
      for (int part = 0; part < kPartCount; ++part)
        if (question.known[t][part])
          EXPECT_TRUE(tests::same_part(answer.motion.poses[t], question.motion.poses[t], part)) << t;
      EXPECT_EQ(answer.doubt_m[t] == 0, question.known[t] == all_parts(true)) << t;
    }
  }
}

TEST_P(MotionSpaces, FillsBeforeTheFirstKnownFrameAndAfterTheLast) {
  for (const auto& [first, last] : {std::pair(0, 9), std::pair(30, 39), std::pair(10, 29)}) {
    const KnownMotion question = dance().question(20, 40, first, last);  // what is not known is NaN
    const Completion answer = space->complete(question);
    for (int t = 0; t < 40; ++t) EXPECT_LT(dance().error(answer.motion, 20, t), 1) << first << ": " << t;
  }
}

TEST_P(MotionSpaces, TurnedQuestionsHaveTurnedAnswers) {
  const KnownMotion question = dance().question(20, 40, 10, 29);
  const Mat3 turn = rotation_about_y(2.1f);
  const Vec3 way(3, 0.5f, -2);
  const Completion straight = space->complete(question),
                   answer = space->complete(tests::turned(question, turn, way));
  EXPECT_LT(tests::farthest(question.rest, answer.motion, tests::turned(straight.motion, turn, way)), 1e-3f);
  for (size_t t = 0; t < 40; ++t) EXPECT_NEAR(answer.doubt_m[t], straight.doubt_m[t], 1e-3f);
}

TEST_P(MotionSpaces, MirroredQuestionsHaveMirroredAnswers) {
  KnownMotion question = dance().question(20, 40, 10, 29);
  if (std::string(GetParam()) != "nearest")
    for (int t = 10; t < 30; ++t) {  // some parts are known
      question.known[t][LeftElbow] = true;
      question.motion.poses[t].local[LeftElbow] = dance().motion.poses[20 + t].local[LeftElbow];
    }
  const Completion straight = space->complete(question), answer = space->complete(tests::mirrored(question));
  EXPECT_LT(tests::farthest(question.rest, answer.motion, tests::mirrored(straight.motion)), 1e-3f);
  EXPECT_GT(tests::farthest(question.rest, answer.motion, straight.motion), 0.1f);
}

TEST_P(MotionSpaces, DoubtGrowsWithTheDistanceToWhatIsKnownAndWithSpeed) {
  const KnownMotion question = dance().question(20, 40, 10, 29);
  const std::vector<float> doubt = space->complete(question).doubt_m;
  for (size_t t = 10; t < 19; ++t) EXPECT_LT(doubt[t], doubt[t + 1]) << t;
  const bool held =
      std::set<std::string>{"hold", "glide", "coast"}.count(GetParam()) > 0;  // from the last on
  for (size_t t = 20; t < 29; ++t) EXPECT_EQ(doubt[t] < doubt[t + 1], held) << t;
  KnownMotion faster = question;
  for (Pose& pose : faster.motion.poses)
    pose.root.x() += 0.1f * static_cast<float>(&pose - &faster.motion.poses[0]);
  EXPECT_GT(space->complete(faster).doubt_m[15], 1.2f * doubt[15]);
}

TEST_P(MotionSpaces, RefuseWhatIsNoQuestion) {
  KnownMotion question = dance().question(20, 40, 0, 39);
  EXPECT_THROW(space->complete(question), Error);
  question.known.pop_back();
  EXPECT_THROW(space->complete(question), Error);
}

TEST(PlainSpaces, HoldKeepsTheLastKnownPoseAndTheFirstBeforeIt) {
  KnownMotion question = dance().question(20, 40, 10, 29);
  for (int t = 0; t < 5; ++t) question.known[t] = all_parts(false);
  const Completion answer = make_hold_space()->complete(question);
  for (int part = 0; part < kPartCount; ++part)
    for (int t = 0; t < 30; ++t)
      if (t < 5 || t > 9)
        EXPECT_TRUE(tests::same_part(answer.motion.poses[t], question.motion.poses[t < 5 ? 5 : 9], part))
            << t;
}

TEST(PlainSpaces, GlidingGoesOnAndCoastingTurnsOnToo) {
  KnownMotion question = dance().question(20, 9, 2, 8);
  auto &before = question.motion.poses[0], &last = question.motion.poses[1];
  before = last = Pose();
  last.local[LeftKnee] = rotation_from_axis_angle(Vec3(0.2f, 0, 0));
  last.root = Vec3(0.1f, 0, 0.05f);
  const Motion glided = make_glide_space()->complete(question).motion,
               coasted = make_coast_space()->complete(question).motion;
  for (const int t : {2, 8}) {
    const float turn = 0.2f * static_cast<float>(t);
    for (const Motion* motion : {&glided, &coasted})
      EXPECT_TRUE(motion->poses[t].root.isApprox(static_cast<float>(t) * last.root, 1e-5f)) << t;
    EXPECT_EQ(glided.poses[t].local[LeftKnee], last.local[LeftKnee]);
    EXPECT_TRUE(coasted.poses[t].local[LeftKnee].isApprox(rotation_from_axis_angle(Vec3(turn, 0, 0)), 1e-4f))
        << t;
  }
  question.known[0] = all_parts(false);  // nobody knows how fast it went
  EXPECT_EQ(make_coast_space()->complete(question).motion.poses[8].root, last.root);
}

TEST(PlainSpaces, SlerpGoesHalfTheShortestTurnInHalfTheTime) {
  KnownMotion question = dance().question(20, 9, 1, 7);
  auto &first = question.motion.poses.front(), &last = question.motion.poses.back();
  first = last = Pose();
  last.local[LeftKnee] = rotation_from_axis_angle(Vec3(2, 0, 0));
  last.root = Vec3(0.8f, 0, 0);
  const Pose middle = make_slerp_space()->complete(question).motion.poses[4];
  EXPECT_TRUE(middle.local[LeftKnee].isApprox(rotation_from_axis_angle(Vec3(1, 0, 0)), 1e-5f));
  EXPECT_TRUE(middle.root.isApprox(Vec3(0.4f, 0, 0), 1e-5f));
}

TEST(PlainSpaces, CurvesAreNearerThanSlerpAndThatThanHolding) {
  const KnownMotion question = dance().question(20, 30, 10, 19);
  const auto error = [&](MotionSpace& space) {
    const Completion answer = space.complete(question);
    double sum = 0;
    for (int t = 10; t < 20; ++t) sum += dance().error(answer.motion, 20, t) / 10;
    return sum;
  };
  EXPECT_LT(error(*make_hermite_space()), 0.7 * error(*make_slerp_space()));
  EXPECT_LT(error(*make_slerp_space()), 0.7 * error(*make_hold_space()));
}

TEST(PlainSpaces, DoubtTellsTheErrorAndItsSize) {
  const auto space = make_hermite_space();
  std::vector<double> doubt, error;
  double doubt_sum = 0, error_sum = 0;
  for (int start = 0; start + 35 <= static_cast<int>(dance().motion.poses.size()); start += 7) {
    const Completion answer = space->complete(dance().question(start, 35, 10, 24));
    for (int t = 10; t < 25; ++t) {
      doubt_sum += doubt.emplace_back(static_cast<double>(answer.doubt_m[t]));
      error_sum += error.emplace_back(dance().error(answer.motion, start, t));
    }
  }
  EXPECT_GT(rank_correlation(doubt, error), 0.4);
  EXPECT_GT(doubt_sum, error_sum / 4);
  EXPECT_LT(doubt_sum, error_sum * 4);
}

/// Somebody who glides along x at 3 m/s; of frames 3 to 5 nothing is known.
KnownMotion gliding() {
  KnownMotion question{
      {30, std::vector<Pose>(9), {}}, std::vector<KnownParts>(9, all_parts(true)), dance().rest};
  for (int t = 0; t < 9; ++t) question.motion.poses[t].root.x() = 0.1f * static_cast<float>(t);
  for (int t = 3; t < 6; ++t) {
    question.known[t] = all_parts(false);
    question.motion.poses[t].root.x() = 100;
  }
  return question;
}

TEST(JointsGoing, IsWhatKnownFramesShow) {
  KnownMotion question = gliding();
  const auto going = [&] { return joints_going(question.known, question.motion, question.rest); };
  EXPECT_NEAR(going()[4].speed, 3, 1e-4f);
  EXPECT_NEAR(going()[4].change, 0, 1e-4f);
  for (int t = 6; t < 9; ++t) question.motion.poses[t].root = Vec3(0.2f, 0, 0.1f * static_cast<float>(t - 2));
  const JointsGoing turned = going()[4];  // off along x, standing across the gap but for 0.4 m along z
  EXPECT_NEAR(turned.speed, 3, 1e-4f);
  EXPECT_NEAR(turned.change, 0.5f * std::sqrt(18.0f), 1e-3f);
}

TEST(JointsGoing, OfOneSideIsItsSpeed) {
  KnownMotion question = gliding();
  for (int t = 6; t < 9; ++t) question.known[t] = all_parts(false);
  const JointsGoing ahead = joints_going(question.known, question.motion, question.rest)[7];
  EXPECT_NEAR(ahead.speed, 3, 1e-4f);
  EXPECT_NEAR(ahead.change, 3, 1e-4f);
}

TEST(JointsGoing, IsUsualWhereTooLittleIsKnown) {
  KnownMotion question = gliding();
  question.known.assign(9, all_parts(false));
  question.known[2] = all_parts(true);
  for (const JointsGoing& usual : joints_going(question.known, question.motion, question.rest)) {
    EXPECT_EQ(usual.speed, 0.5f);
    EXPECT_EQ(usual.change, 0.5f);
  }
}

}  // namespace
}  // namespace understudy
