// Gaps filled by fitted steps; the coder is linear and knows the built-in walk alone.
#include "retarget/motion_space/paper_space.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/confidence.hpp"
#include "retarget/motion_space/linear_coder.hpp"
#include "retarget/motion_space/step_fit.hpp"
#include "retarget/motion_space/steps.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy {
namespace {

using tests::KnownWalk;

const KnownWalk& walk() {
  static const KnownWalk made("walk");
  return made;
}

/// Cycles of the walk, and of it in a mirror, from every other frame on, at three speeds.
std::unique_ptr<MotionCoder> walk_coder() {
  std::vector<StepNumbers> numbers;
  const Step step = find_steps(walk().motion)[1];
  const int frames = step.last - step.first;
  for (const bool mirror : {false, true})
    for (int first = 0; first + frames < ssize(walk().motion.poses); first += 2) {
      Motion motion = walk().motion;
      if (mirror) motion = tests::mirrored(motion);
      const TimedPoses movement = movement_of(motion, first, first + frames);
      for (const float slower : {0.8f, 1.0f, 1.25f}) {
        TimedPoses other = movement;
        for (float& seconds : other.seconds) seconds *= slower;
        numbers.push_back(step_numbers(other, walk().rest));
      }
    }
  RowMatrix rows(ssize(numbers), kStepNumbers);
  for (int i = 0; i < ssize(numbers); ++i) rows.row(i) = numbers[i].transpose();
  return fit_linear_coder(rows, 8);
}

Completion completed(const KnownMotion& question) {
  return PaperSpace(walk_coder()).complete(question);
}

Motion curve_of(const KnownMotion& question) {
  Motion curve = question.motion;
  fill_curves(question.known, 0, ssize(curve.poses) - 1, curve);
  return curve;
}

TEST(PaperSpace, FillsAWalkBetterThanTheCurveAndSaysSo) {
  const int start = 40, first = 20, last = 39;
  const KnownMotion question = walk().question(start, 60, first, last);
  const Completion made = completed(question);
  const Motion curve = curve_of(question);
  std::vector<double> errors, doubts;
  double error = 0, curve_error = 0;
  for (int t = first; t <= last; ++t) {
    errors.push_back(walk().error(made.motion, start, t));
    doubts.push_back(static_cast<double>(made.doubt_m[t]));
    error += errors.back();
    curve_error += walk().error(curve, start, t);
  }
  EXPECT_LT(error, 0.5 * curve_error);
  EXPECT_GT(rank_correlation(doubts, errors), 0.4);
}

TEST(PaperSpace, KeepsWhatIsKnownToTheBit) {
  KnownMotion question = walk().question(40, 60, 20, 39);
  for (int t = 28; t <= 32; ++t) {
    question.known[t][LeftElbow] = true;
    question.motion.poses[t].local[LeftElbow] = walk().motion.poses[40 + t].local[LeftElbow];
  }
  const Completion made = completed(question);
  EXPECT_EQ(PaperSpace(walk_coder()).name(), "paper");
  for (int t = 0; t < 60; ++t) {
    for (int part = 0; part < kPartCount; ++part)
      if (question.known[t][part])
        EXPECT_TRUE(tests::same_part(made.motion.poses[t], question.motion.poses[t], part)) << t;
    EXPECT_EQ(made.doubt_m[t] == 0, question.known[t] == all_parts(true)) << t;
  }
}

TEST(PaperSpace, AnswersTheSameTwiceAndTurnedAndMirroredAlike) {
  const KnownMotion question = walk().question(40, 50, 12, 35);
  PaperSpace space(walk_coder());
  const Motion made = space.complete(question).motion, again = space.complete(question).motion;
  for (size_t t = 0; t < made.poses.size(); ++t)
    for (int part = 0; part < kPartCount; ++part)
      ASSERT_TRUE(tests::same_part(made.poses[t], again.poses[t], part)) << t;
  const Mat3 turn = rotation_about_y(2);
  const Vec3 way(1, 0, -2);
  const Motion turned = space.complete(tests::turned(question, turn, way)).motion;
  EXPECT_LT(tests::farthest(walk().rest, tests::turned(made, turn, way), turned), 1e-3f);
  KnownMotion mirror = tests::mirrored(question);
  const Motion mirrored = space.complete(mirror).motion;
  EXPECT_LT(tests::farthest(walk().rest, tests::mirrored(made), mirrored), 1e-3f);
}

TEST(PaperSpace, GoesOnAfterTheLastKnownFrame) {
  const KnownMotion question = walk().question(20, 60, 40, 59);
  const Completion made = completed(question);
  const Motion curve = curve_of(question);
  EXPECT_LT(walk().error(made.motion, 20, 59), 0.5 * walk().error(curve, 20, 59));
}

TEST(PaperSpace, ALongGapStaysTheCurve) {
  KnownMotion question = walk().question(0, 150, 10, 139);
  const Motion made = completed(question).motion, curve = curve_of(question);
  EXPECT_LT(tests::farthest(walk().rest, made, curve), 1e-6f);
}

TEST(PaperSpace, WhereNoFrameIsWhollyKnownNearbyTheCurveIsAll) {
  KnownMotion question = walk().question(0, 150, 10, 149);
  for (int t = 10; t < 150; ++t) {
    question.motion.poses[t] = walk().motion.poses[t];
    question.known[t] = all_parts(true);
    question.known[t][RightWrist] = false;
  }
  const Motion made = completed(question).motion, curve = curve_of(question);
  EXPECT_LT(tests::farthest(walk().rest, made, curve), 1e-5f);
}

TEST(PaperSpace, RefusesQuestionsOfWhichNothingIsKnown) {
  EXPECT_THROW(completed(walk().question(0, 30, 0, 29)), Error);
}

TEST(StepFit, FindsTheMovementThatIsKnownAndRefusesNothing) {
  const KnownMotion question = walk().question(40, 60, 20, 39);
  const Motion curve = curve_of(question);
  MotionWindow window = windows_of(question.known, curve, question.rest).at(0);
  const auto coder = walk_coder();
  const Step step = find_steps(walk().motion)[1];
  const auto start = coder->encode(movement_of(walk().motion, step.first, step.last), walk().rest).mean;
  const FittedStep fitted = fit_step(*coder, window, {start});
  EXPECT_EQ(fitted.poses.size(), window.curve.size());
  EXPECT_LT(fitted.error_m, 0.03f);
  EXPECT_THROW(fit_step(*coder, window, {}), Error);
  for (KnownDistance& distance : window.distance) distance[Head] = {1, 1};
  EXPECT_THROW(fit_step(*coder, window, {start}), Error);
}

}  // namespace
}  // namespace understudy
