#include "retarget/motion_space/blend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/motion_space/knot_coder.hpp"
#include "retarget/motion_space/steps.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy::tests {
namespace {

/// A step of the built-in walk, left foot first, in another tempo.
BlendInput a_step(float tempo = 1, bool left_first = true) {
  static const KnownWalk walk("walk");
  static const std::vector<Step> steps = find_steps(walk.motion);
  BlendInput input;
  input.rest = walk.rest;
  for (const Step& step : steps)
    if (step.left_first == left_first && input.movement.poses.empty())
      input.movement = movement_of(walk.motion, step.first, step.last);
  for (float& seconds : input.movement.seconds) seconds /= tempo;
  return input;
}

BlendInput taller(BlendInput input, float by) {
  input.rest *= by;
  for (Pose& pose : input.movement.poses) pose.root *= by;
  return input;
}

/// The same step from its end to its beginning.
BlendInput backward(BlendInput input) {
  Motion motion;
  motion.fps = 30;
  motion.poses.assign(input.movement.poses.rbegin(), input.movement.poses.rend());
  const float duration = input.movement.duration();
  input.movement = movement_of(motion, 0, static_cast<int>(ssize(motion.poses)) - 1);
  for (float& seconds : input.movement.seconds) seconds *= duration / input.movement.duration();
  return input;
}

/// Both arms up.
BlendInput arms_up(BlendInput input) {
  for (Pose& pose : input.movement.poses)
    for (const int arm : {LeftShoulder, RightShoulder})
      pose.local[arm] =
          rotation_from_axis_angle(Vec3(0, 0, arm == LeftShoulder ? 1.5f : -1.5f)) * pose.local[arm];
  return input;
}

/// One that says of everything that it takes a second and a bit, the more the farther its code is from 0, and
/// that lowers one knee: as wrong as a learned coder may be.
class WrongCoder final : public MotionCoder {
 public:
  int size() const override { return right_->size(); }
  std::string name() const override { return "wrong"; }
  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    return right_->encode(movement, rest);
  }
  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    TimedPoses movement = right_->decode(code, rest);
    for (size_t k = 0; k < movement.poses.size(); ++k) {
      movement.seconds[k] = (1 + 0.3f * std::sin(40 * code[9])) * static_cast<float>(k) / 19;
      movement.poses[k].local[LeftKnee] *= rotation_from_axis_angle(Vec3(0.2f, 0, 0));
    }
    return movement;
  }

 private:
  std::unique_ptr<MotionCoder> right_ = make_knot_coder();
};

Motion motion_of(const BlendInput& input, float fps) {
  Motion motion;
  motion.fps = fps;
  for (float t = 0; t <= input.movement.duration(); t += 1 / fps)
    motion.poses.push_back(pose_at(input.movement, t));
  return motion;
}

JointSequence joints_of(const Motion& motion, const Joints& rest) {
  JointSequence joints;
  for (const Pose& pose : motion.poses) joints.push_back(forward_kinematics(rest, pose).joints);
  return joints;
}

float farthest(const Blended& a, const BlendInput& b) {
  float most = 0;
  const auto poses = sampled_evenly(b.movement, Blend::kSamples);
  for (int k = 0; k < Blend::kSamples; ++k)
    most = std::max(most, (forward_kinematics(a.rest, a.movement.poses[k]).joints -
                           forward_kinematics(b.rest, poses[k]).joints)
                              .rowwise()
                              .norm()
                              .maxCoeff());
  return most;
}

TEST(Blend, AnInputWithAllOfTheWeightIsGivenAsItWasCaptured) {
  WrongCoder coder;
  const BlendInput walk = a_step(), other = arms_up(taller(a_step(0.8f), 1.2f));
  const Blend blend(coder, {walk, other});
  for (const auto& [weights, end] : {std::pair(std::vector<float>{1, 0}, walk), {{0, 2}, other}}) {
    const Blended made = blend.at(weights);
    EXPECT_LT(farthest(made, end), 1e-3f);
    EXPECT_NEAR(made.movement.duration(), end.movement.duration(), 1e-4f);
    EXPECT_LT((made.rest - end.rest).norm(), 1e-4f);
  }
}

TEST(Blend, DurationsGoMonotoneFromOneEndToTheOther) {
  WrongCoder coder;
  const Blend blend(coder, {a_step(), a_step(1.6f)});
  float before = std::numeric_limits<float>::infinity();
  for (const auto& weights : weights_along(2, 9)) {
    const Blended made = blend.at(weights);
    EXPECT_LT(made.movement.duration(), before);
    before = made.movement.duration();
    for (size_t k = 1; k < made.movement.seconds.size(); ++k)
      ASSERT_GT(made.movement.seconds[k], made.movement.seconds[k - 1]);
  }
}

TEST(Blend, HalfWayBetweenForwardAndBackwardIsASmallStep) {
  const auto coder = make_knot_coder();
  const BlendInput forward = a_step();
  const Blend blend(*coder, {forward, backward(a_step(1, false))});
  const float far = forward.movement.poses.back().root.z();
  const Vec3 way = blend.at({1, 1}).movement.poses.back().root;
  EXPECT_GT(far, 0.5f);
  EXPECT_LT(std::abs(way.z()), 0.1f * far);
}

TEST(Blend, FeetThatStandDoNotSlide) {
  const auto coder = make_knot_coder();
  const BlendInput walk = a_step(), tall = taller(a_step(1.3f), 1.15f);
  const Blend blend(*coder, {walk, tall});
  for (const auto& weights : weights_along(2, 5)) {
    const Blended made = blend.at(weights);
    const Motion motion = played(made, 60);
    int stood = 0;
    for (const Standing& standing : motion.standing) stood += standing[0] || standing[1];
    EXPECT_GT(stood, 0.5 * static_cast<double>(motion.standing.size()));
    const double skate = foot_skate(joints_of(motion, made.rest), 60);
    EXPECT_LT(skate, foot_skate(joints_of(motion_of(walk, 60), walk.rest), 60) + 0.05) << weights[0];
  }
}

TEST(Blend, DoubtIsLeastAtTheEndsAndGrowsWithHowUnlikeTheyAre) {
  const auto coder = make_knot_coder();
  const Blend alike(*coder, {a_step(), a_step(1.2f)}), unlike(*coder, {a_step(), arms_up(a_step())});
  EXPECT_LT(alike.distance(0, 1), unlike.distance(1, 0));
  EXPECT_EQ(unlike.distance(0, 0), 0);
  const auto doubt = [](const Blend& blend, float share) { return blend.at({1 - share, share}).doubt_m[50]; };
  EXPECT_FLOAT_EQ(doubt(unlike, 0), Blend::kLeastDoubt_m);
  EXPECT_FLOAT_EQ(doubt(unlike, 1), Blend::kLeastDoubt_m);
  EXPECT_GT(doubt(unlike, 0.5f), doubt(unlike, 0.25f));
  EXPECT_GT(doubt(unlike, 0.5f), doubt(alike, 0.5f));
  WrongCoder wrong;
  EXPECT_GT(doubt(Blend(wrong, {a_step(), arms_up(a_step())}), 0.5f), doubt(unlike, 0.5f))
      << "what the coder gets wrong counts";
}

TEST(Blend, OfThreeIsAtTheirMiddle) {
  const auto coder = make_knot_coder();
  const Blend blend(*coder, {a_step(1), a_step(0.5f), taller(a_step(2), 1.3f)});
  const Blended made = blend.at({2, 2, 2});
  const float duration = a_step().movement.duration();
  EXPECT_NEAR(made.movement.duration(), duration * (1 + 2 + 0.5f) / 3, 1e-3f);
  EXPECT_NEAR(leg_length(made.rest), 1.1f * leg_length(a_step().rest), 1e-4f);
}

TEST(Blend, OfMirroredMovementsIsMirrored) {
  const auto coder = make_knot_coder();
  const auto mirror = [](BlendInput input) {
    return BlendInput{mirrored(std::move(input.movement)), understudy::mirrored(input.rest)};
  };
  const BlendInput walk = a_step(), other = arms_up(a_step(0.7f));
  const Blended made = Blend(*coder, {walk, other}).at({0.3f, 0.7f}),
                seen = Blend(*coder, {mirror(walk), mirror(other)}).at({0.3f, 0.7f});
  for (int k = 0; k < Blend::kSamples; ++k) {
    const Joints a =
        forward_kinematics(understudy::mirrored(made.rest), mirrored(made.movement.poses[k])).joints;
    const Joints b = forward_kinematics(seen.rest, seen.movement.poses[k]).joints;
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-3f);
  }
}

TEST(Blend, RefusesWhatItCannotWeigh) {
  const auto coder = make_knot_coder();
  const BlendInput walk = a_step();
  EXPECT_THROW(Blend(*coder, {walk}), Error);
  EXPECT_THROW(Blend(*coder, {walk, walk, walk, walk, walk}), Error);
  const Blend blend(*coder, {walk, walk});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::vector<float>& weights :
       {std::vector<float>{1},
        {1, 1, 1},
        {0, 0},
        {-1, 2},
        {nan, 1},
        {std::numeric_limits<float>::max(), std::numeric_limits<float>::max()}})
    EXPECT_THROW(blend.at(weights), Error);
}

TEST(Blend, OfOnePoseOrFallingTimesIsRefused) {
  const auto coder = make_knot_coder();
  BlendInput still = a_step(), falling = a_step(), long_one = a_step(0.05f);
  still.movement.poses.resize(1), still.movement.seconds.resize(1);
  falling.movement.seconds[3] = falling.movement.seconds[2];
  for (const BlendInput& bad : {still, falling, long_one})
    EXPECT_THROW(Blend(*coder, {a_step(), bad}), Error);
}

TEST(Played, GoesOnFromWhereTheCycleBeforeCameTo) {
  const auto coder = make_knot_coder();
  const Blended made = Blend(*coder, {a_step(), taller(a_step(0.8f), 1.2f)}).at({1, 1});
  const Motion once = played(made, 60), many = played(made, 60, 4);
  const float way = once.poses.back().root.z();
  EXPECT_NEAR(many.poses.back().root.z(), 4 * way, 0.15f * way);
  EXPECT_NEAR(static_cast<double>(many.poses.size()), 4 * static_cast<double>(once.poses.size()), 6);
  EXPECT_EQ(many.doubt_m.size(), many.poses.size());
  const JointSequence joints = joints_of(many, made.rest), of_one = joints_of(once, made.rest);
  const auto fastest = [](const JointSequence& all) {
    float most = 0;
    for (size_t t = 1; t < all.size(); ++t)
      most = std::max(most, (all[t] - all[t - 1]).rowwise().norm().maxCoeff());
    return most;
  };
  EXPECT_LT(fastest(joints), 1.2f * fastest(of_one)) << "no jump at a seam";
}

TEST(Played, RefusesRatesAndCyclesThatAreNone) {
  const auto coder = make_knot_coder();
  const Blended made = Blend(*coder, {a_step(), a_step()}).at({1, 0});
  EXPECT_THROW(played(made, 0), Error);
  EXPECT_THROW(played(made, std::numeric_limits<float>::quiet_NaN()), Error);
  EXPECT_THROW(played(made, 30, 0), Error);
  EXPECT_THROW(played(made, 30, 100000), Error);
}

TEST(LeftLead, TellsWhichFootStridesFirstAndWhereNobodySteps) {
  EXPECT_GT(left_lead(a_step(1, true).movement), kLeastLead);
  EXPECT_LT(left_lead(a_step(1, false).movement), -kLeastLead);
  EXPECT_FLOAT_EQ(left_lead(mirrored(a_step().movement)), -left_lead(a_step().movement));
  BlendInput stands = a_step();
  for (Pose& pose : stands.movement.poses) pose.local = identity_rotations();
  EXPECT_EQ(left_lead(stands.movement), 0);
}

TEST(WeightsAlong, GoFromEachMovementToTheNext) {
  EXPECT_EQ(weights_along(2, 3), (std::vector<std::vector<float>>{{1, 0}, {0.5f, 0.5f}, {0, 1}}));
  const auto three = weights_along(3, 5);
  EXPECT_EQ(three[2], (std::vector<float>{0, 1, 0}));
  EXPECT_EQ(three[3], (std::vector<float>{0, 0.5f, 0.5f}));
  EXPECT_EQ(three.back(), (std::vector<float>{0, 0, 1}));
  EXPECT_THROW(weights_along(2, 1), Error);
}

TEST(KnotCoder, GivesAMovementBackFromItsCode) {
  const auto coder = make_knot_coder();
  const BlendInput walk = a_step();
  const MotionCode code = coder->encode(walk.movement, walk.rest);
  EXPECT_EQ(ssize(code.mean), coder->size());
  const TimedPoses back = coder->decode(code.mean, walk.rest);
  EXPECT_NEAR(back.duration(), walk.movement.duration(), 1e-5f);
  for (size_t k = 0; k < back.poses.size(); ++k) {
    const Joints a = forward_kinematics(walk.rest, back.poses[k]).joints;
    const Joints b = forward_kinematics(walk.rest, pose_at(walk.movement, back.seconds[k])).joints;
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-4f);
  }
  EXPECT_THROW(coder->decode({1, 2}, walk.rest), Error);
  std::vector<float> broken = code.mean;
  broken[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(coder->decode(broken, walk.rest), Error);
}

}  // namespace
}  // namespace understudy::tests
