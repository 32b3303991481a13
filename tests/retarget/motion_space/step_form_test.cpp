// Movements as rows of numbers and as codes of a linear space, and how coders are judged.
#include "retarget/motion_space/step_form.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/linear_coder.hpp"
#include "retarget/motion_space/step_score.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy {
namespace {

using tests::KnownWalk;

TimedPoses walked(const KnownWalk& walk) {
  return movement_of(walk.motion, 26, 60);
}

/// The farthest that a joint is from where it was at the same moment, metres.
float farthest_at(const Joints& rest, const TimedPoses& a, const TimedPoses& b) {
  float most = 0;
  for (float s = 0; s <= a.duration(); s += 0.02f)
    most = std::max(most, (forward_kinematics(rest, pose_at(a, s)).joints -
                           forward_kinematics(rest, pose_at(b, s)).joints)
                              .rowwise()
                              .norm()
                              .maxCoeff());
  return most;
}

TEST(StepForm, AMovementSurvivesThere) {
  const KnownWalk walk("walk");
  const TimedPoses movement = walked(walk);
  const TimedPoses back = movement_of_numbers(step_numbers(movement, walk.rest), walk.rest);
  ASSERT_EQ(ssize(back.poses), kKnots);
  EXPECT_NEAR(back.duration(), movement.duration(), 1e-5f);
  EXPECT_LT(farthest_at(walk.rest, movement, back), 0.03f);  // between knots it is slerp
}

TEST(StepForm, SaysNothingOfPlaceAndHeading) {
  const KnownWalk walk("walk");
  const Motion there = tests::turned(walk.motion, rotation_about_y(2.5f), Vec3(-3, 0, 8));
  TimedPoses raw;  // not brought to the origin by movement_of
  for (int t = 26; t <= 60; ++t) {
    raw.poses.push_back(there.poses[t]);
    raw.seconds.push_back(static_cast<float>(t - 26) / 30);
  }
  EXPECT_LT((step_numbers(raw, walk.rest) - step_numbers(walked(walk), walk.rest)).cwiseAbs().maxCoeff(),
            1e-4f);
}

TEST(StepForm, IsAnotherInAMirrorAndForAnotherTempo) {
  const KnownWalk walk("walk");
  const TimedPoses movement = walked(walk);
  TimedPoses mirror = movement, slow = movement;
  for (Pose& pose : mirror.poses) pose = mirrored(pose);
  for (float& s : slow.seconds) s *= 1.2f;
  const StepNumbers plain = step_numbers(movement, walk.rest);
  EXPECT_GT((step_numbers(mirror, walk.rest) - plain).norm(), 1);
  const StepNumbers apart = step_numbers(slow, walk.rest) - plain;
  EXPECT_LT(apart.head(kStepTurns + kStepPath).norm(), 1e-4f);
  EXPECT_GT(apart.tail(kStepTimes).norm(), 0.1f);
}

TEST(StepForm, PathsAreInLegs) {
  const KnownWalk walk("walk");
  const TimedPoses movement = walked(walk);
  const Joints tall = 1.2f * walk.rest;
  const TimedPoses made = movement_of_numbers(step_numbers(movement, walk.rest), tall);
  EXPECT_NEAR(made.poses.back().root.z(), 1.2f * movement.poses.back().root.z(), 1e-3f);
  EXPECT_NEAR(made.poses.front().root.y(), 1.2f * movement.poses.front().root.y(), 1e-3f);
}

TEST(StepForm, WhateverTheNumbersAreTimesRiseAndItBeginsAtTheOrigin) {
  const KnownWalk walk("walk");
  StepNumbers numbers = StepNumbers::Constant(kStepNumbers, 0.3f);
  for (int k = 0; k < kStepTimes; ++k) numbers(kStepTurns + kStepPath + k) = k % 2 == 0 ? 0.2f : 0.1f;
  const TimedPoses made = movement_of_numbers(numbers, walk.rest);
  EXPECT_EQ(made.seconds.front(), 0);
  for (size_t k = 1; k < made.seconds.size(); ++k) EXPECT_GT(made.seconds[k], made.seconds[k - 1]);
  EXPECT_NEAR(made.poses.front().root.x(), 0, 1e-6f);
  EXPECT_NEAR(made.poses.front().root.z(), 0, 1e-6f);
  EXPECT_NEAR(heading_of(made.poses.front().local[Pelvis]), 0, 1e-5f);
  numbers(7) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(movement_of_numbers(numbers, walk.rest), Error);
  EXPECT_THROW(movement_of_numbers(StepNumbers::Zero(12), walk.rest), Error);
}

TEST(StepForm, RefusesWhatIsNoMovement) {
  const KnownWalk walk("walk");
  const auto refused = [&](auto change) {
    TimedPoses movement = walked(walk);
    change(movement);
    EXPECT_THROW(step_numbers(movement, walk.rest), Error);
  };
  refused([](TimedPoses& m) { m = {}; });
  refused([](TimedPoses& m) { m.poses.resize(1), m.seconds.resize(1); });
  refused([](TimedPoses& m) { m.seconds.pop_back(); });
  refused([](TimedPoses& m) { m.seconds[3] = m.seconds[2]; });
  refused([](TimedPoses& m) { std::swap(m.seconds[3], m.seconds[2]); });
  refused([](TimedPoses& m) { m.seconds[4] = std::numeric_limits<float>::quiet_NaN(); });
  refused([](TimedPoses& m) { m.seconds.back() = 10.5f; });
  refused([](TimedPoses& m) { m.seconds[0] = 0.001f; });
  refused([](TimedPoses& m) { m.poses[5].root.x() = std::numeric_limits<float>::infinity(); });
}

/// Rows of the walk, quicker and slower, longer and shorter: two directions and no more.
RowMatrix rows_of_walks(const KnownWalk& walk, int count) {
  const StepNumbers plain = step_numbers(walked(walk), walk.rest);
  RowMatrix rows(count, kStepNumbers);
  for (int i = 0; i < count; ++i) {
    const float a = std::sin(static_cast<float>(i)), b = std::cos(1.7f * static_cast<float>(i));
    StepNumbers row = plain;
    row.segment(kStepTurns, kStepPath) *= 1 + 0.2f * a;
    row.tail(kStepTimes) *= 1 + 0.3f * b;
    rows.row(i) = row;
  }
  return rows;
}

TEST(LinearCoder, HoldsWhatLiesInItsDirections) {
  const KnownWalk walk("walk");
  const auto coder = fit_linear_coder(rows_of_walks(walk, 12), 2);
  EXPECT_EQ(coder->size(), 2);
  const TimedPoses movement = walked(walk);
  const MotionCode code = coder->encode(movement, walk.rest);
  ASSERT_EQ(code.mean.size(), 2u);
  const TimedPoses made = coder->decode(code.mean, walk.rest);
  EXPECT_NEAR(made.duration(), movement.duration(), 0.01f);
  EXPECT_LT(farthest_at(walk.rest, movement, made), 0.03f);
  EXPECT_THROW(coder->decode({1}, walk.rest), Error);
  EXPECT_THROW(coder->decode({1, std::numeric_limits<float>::quiet_NaN()}, walk.rest), Error);
}

TEST(LinearCoder, IsTheSameTwiceAndRefusesTooFewSteps) {
  const KnownWalk walk("walk");
  const RowMatrix rows = rows_of_walks(walk, 12);
  EXPECT_EQ(fit_linear_coder(rows, 2)->encode(walked(walk), walk.rest).mean,
            fit_linear_coder(rows, 2)->encode(walked(walk), walk.rest).mean);
  EXPECT_THROW(fit_linear_coder(rows, 12), Error);
  EXPECT_THROW(fit_linear_coder(rows, 0), Error);
}

/// Gives back what it was given, half a leg further to the left and slower.
class OffCoder final : public MotionCoder {
 public:
  explicit OffCoder(float off) : off_(off) {}
  int size() const override { return kStepNumbers; }
  std::string name() const override { return "off"; }
  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    const StepNumbers numbers = step_numbers(movement, rest);
    return {{numbers.data(), numbers.data() + numbers.size()}, {}};
  }
  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    TimedPoses made = movement_of_numbers(Eigen::Map<const StepNumbers>(code.data(), ssize(code)), rest);
    for (Pose& pose : made.poses) pose.root.x() += off_ * leg_length(rest);
    for (float& s : made.seconds) s += off_ * s / made.duration();
    return made;
  }

 private:
  float off_;
};

class StepScores : public ::testing::Test {
 protected:
  StepScores() : body_(builtin_person()) {
    const KnownWalk walk("walk");
    clip_.clip.motion = walk.motion;
    clip_.rest = 0.8f * body_.joints;  // somebody smaller
    clip_.walks = true;
    clip_.steps = find_steps(walk.motion);
  }
  ShapedBody body_;
  StepClip clip_;
};

TEST_F(StepScores, AnHonestCoderIsJudgedByItsKnotsAlone) {
  OffCoder coder(0);
  const StepScore score = score_steps(coder, {clip_}, body_, {20, 200});
  EXPECT_EQ(score.all.steps, ssize(clip_.steps));
  EXPECT_EQ(score.walks.steps, score.all.steps);
  EXPECT_LT(score.all.joints_mm, 2);
  EXPECT_LT(score.all.vertices_mm, 3);
  EXPECT_NEAR(score.all.duration_ms, 0, 0.1);
}

TEST_F(StepScores, WhatIsAsideAndSlowIsToldOnTheMeanBody) {
  OffCoder coder(0.05f);
  clip_.walks = false;
  const StepScore score = score_steps(coder, {clip_}, body_, {20, 200});
  const double aside = 50 * static_cast<double>(leg_length(body_.joints));
  EXPECT_NEAR(score.all.joints_mm, aside, 1);
  EXPECT_NEAR(score.all.vertices_mm, aside, 1);
  EXPECT_NEAR(score.all.duration_ms, 50, 0.1);
  EXPECT_EQ(score.walks.steps, 0);
  EXPECT_EQ(score.walks.joints_mm, 0);
}

TEST_F(StepScores, TheSurfaceGoesAsFarAsThePathAndFartherWithTheHipThanWithTheHand) {
  const StepNumbers numbers = step_numbers(performed_step(clip_, clip_.steps[1], 0.8f), clip_.rest);
  const StepNumbers reach = surface_reach(body_, numbers);
  EXPECT_NEAR(reach(kStepTurns + 4), leg_length(body_.joints), 1e-3f);
  EXPECT_EQ(reach(kStepNumbers - 1), 1);
  EXPECT_EQ(reach(0), reach(kKnotTurns));  // of another knot
  const auto of = [&](int joint) { return reach.segment(6 * joint, 6).norm(); };
  EXPECT_GT(of(Pelvis), of(LeftHip));
  EXPECT_GT(of(LeftHip), of(LeftKnee));
  EXPECT_GT(of(LeftElbow), of(LeftWrist));
  EXPECT_NEAR(of(LeftHip), of(RightHip), 0.5f * of(LeftHip));
}

TEST_F(StepScores, RowsAreOfStepsAndTheirMirrorImages) {
  const RowMatrix rows = step_rows({clip_}, leg_length(body_.joints));
  ASSERT_EQ(rows.rows(), 2 * ssize(clip_.steps));
  for (Eigen::Index i = 0; i < rows.rows(); i += 2)
    for (int k = 0; k < kKnots; ++k) {
      const int at = kStepTurns + 3 * k;
      EXPECT_NEAR(rows(i, at), -rows(i + 1, at), 1e-5f);
      EXPECT_NEAR(rows(i, at + 2), rows(i + 1, at + 2), 1e-5f);
    }
}

}  // namespace
}  // namespace understudy
