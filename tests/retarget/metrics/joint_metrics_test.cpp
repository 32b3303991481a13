// Joint and rotation metrics against values worked out by hand.
#include "retarget/metrics/joint_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// Some joints in general position: no symmetry, no plane.
Joints some_joints() {
  Joints x;
  for (int j = 0; j < kJointCount; ++j) x.row(j) << std::sin(1.7f * j), 0.1f * j, std::cos(2.3f * j + 0.4f);
  return x;
}

/// A standing person: left is +x, feet on the floor.
Joints standing() {
  Joints x;
  x << 0, 1, 0, .1f, .9f, 0, -.1f, .9f, 0, 0, 1.1f, 0, .1f, .5f, 0, -.1f, .5f, 0, 0, 1.2f, 0, .1f, .1f, 0,
      -.1f, .1f, 0, 0, 1.3f, 0, .1f, .02f, .1f, -.1f, .02f, .1f, 0, 1.5f, 0, .05f, 1.4f, 0, -.05f, 1.4f, 0, 0,
      1.6f, 0, .2f, 1.4f, 0, -.2f, 1.4f, 0, .45f, 1.4f, 0, -.45f, 1.4f, 0, .7f, 1.4f, 0, -.7f, 1.4f, 0;
  return x;
}

Joints moved(const Joints& x, const Vec3& by) {
  return (x.rowwise() + by.transpose()).eval();
}

TEST(MeanJointError, IsTheLengthOfAShift) {
  const JointSequence truth(3, some_joints()), shifted(3, moved(some_joints(), {0.03f, 0, 0.04f}));
  EXPECT_NEAR(mean_joint_error(shifted, truth), 0.05, 1e-6);
}

TEST(MeanJointError, AveragesOverFramesAndJoints) {
  const JointSequence truth(2, some_joints());
  JointSequence predicted = truth;
  predicted[1](7, 1) += 0.44f;  // one of 44 joints is off by 0.44
  EXPECT_NEAR(mean_joint_error(predicted, truth), 0.01, 1e-6);
}

TEST(MeanJointError, RefusesDifferentLengths) {
  EXPECT_THROW(mean_joint_error(JointSequence(2), JointSequence(3)), Error);
  EXPECT_THROW(mean_joint_error({}, {}), Error);
}

TEST(SeenJointError, IsOfTheJointsThatAreSeen) {
  Joints truth = Joints::Zero(), predicted = truth;
  predicted.row(Head).y() = 0.3f;
  predicted.row(LeftFoot).x() = 100;
  SeenJoints seen = SeenJoints::Zero();
  EXPECT_TRUE(std::isnan(seen_joint_error({predicted}, {truth}, {seen})));
  for (const int j : {Head, Neck, Spine3}) seen[j] = 1;
  EXPECT_NEAR(seen_joint_error({predicted}, {truth}, {seen}), 0.1, 1e-7);
  EXPECT_THROW(seen_joint_error({predicted}, {truth}, {}), Error);
}

TEST(VisibilityRight, IsTheShareOfJointsOnTheRightSideOfOneHalf) {
  SeenJoints truth = SeenJoints::Ones(), predicted = SeenJoints::Constant(0.6f);
  EXPECT_EQ(visibility_right({predicted}, {truth}), 1);
  for (int j = 0; j < 11; ++j) truth[j] = 0;
  EXPECT_EQ(visibility_right({predicted}, {truth}), 0.5);
  EXPECT_EQ(visibility_right({SeenJoints(1 - truth)}, {truth}), 0);
}

TEST(AlignedJoints, UndoARotationAScaleAndAShift) {
  const Joints q = some_joints();
  const Joints p = moved(2.0f * q * rotation_about_y(0.8f).transpose(), {1, 2, 3});
  EXPECT_GT(mean_joint_error({p}, {q}), 0.5);
  EXPECT_LT(mean_joint_error(aligned_joints({p}, {q}), {q}), 1e-5);
}

TEST(AlignedJoints, DoNotUndoAMirror) {
  Joints p = some_joints();
  p.col(0) *= -1;
  EXPECT_GT(mean_joint_error(aligned_joints({p}, {some_joints()}), {some_joints()}), 0.1);
}

TEST(AccelerationError, IsTheSecondDifferenceOfAParabola) {
  JointSequence truth(5, some_joints()), predicted = truth;
  for (int t = 0; t < 5; ++t)
    predicted[t] = moved(some_joints(), {0, 0.01f * t * t, 0});  // second difference 0.02
  EXPECT_NEAR(acceleration_error(predicted, truth, 30), 0.02, 1e-5);
}

TEST(AccelerationError, IgnoresConstantVelocity) {
  JointSequence truth(5, some_joints()), predicted = truth;
  for (int t = 0; t < 5; ++t) predicted[t] = moved(some_joints(), {0.1f * t, 0, 0});
  EXPECT_NEAR(acceleration_error(predicted, truth, 30), 0, 1e-5);
}

TEST(AccelerationError, IsToldAtThirtyFramesASecond) {
  // y = t^2 / 2 with t in seconds: at 30 frames/s the second difference is 1/900, at 60 it would be 1/3600.
  JointSequence truth(9, some_joints()), predicted = truth;
  for (int t = 0; t < 9; ++t) predicted[t] = moved(some_joints(), {0, 0.5f * (t / 60.0f) * (t / 60.0f), 0});
  EXPECT_NEAR(acceleration_error(predicted, truth, 60), 1.0 / 900, 1e-6);
}

TEST(AccelerationError, IsUnknownForTwoFrames) {
  const JointSequence two(2, some_joints());
  EXPECT_TRUE(std::isnan(acceleration_error(two, two, 30)));
}

TEST(Resampled, MeetsTheLineBetweenFrames) {
  JointSequence x(3, Joints::Zero());
  for (int t = 0; t < 3; ++t) x[t].setConstant(static_cast<float>(t));
  const JointSequence y = resampled(x, 20, 30);  // times 0, 2/3, 4/3, 2 of the old frames
  ASSERT_EQ(y.size(), 4u);
  EXPECT_NEAR(y[1](0, 0), 2.0f / 3, 1e-6);
  EXPECT_NEAR(y[2](5, 2), 4.0f / 3, 1e-6);
  EXPECT_NEAR(y[3](21, 1), 2.0f, 1e-6);
}

TEST(SwapRate, CountsFramesAndLimbs) {
  const JointSequence truth(2, standing());
  JointSequence predicted = truth;
  for (const int j : {LeftHip, LeftKnee, LeftAnkle, LeftFoot})
    predicted[0].row(j).swap(predicted[0].row(kMirror[j]));
  EXPECT_DOUBLE_EQ(swap_rate(predicted, truth), 0.25);  // the legs of one frame, of 2 frames x (legs, arms)
  EXPECT_DOUBLE_EQ(swap_rate(truth, truth), 0);
}

TEST(FlipRate, CountsBodiesSeenFromBehind) {
  const JointSequence truth(4, standing());
  JointSequence predicted = truth;
  predicted[2] = predicted[2] * rotation_about_y(kPi * 0.6f).transpose();
  predicted[3] = predicted[3] * rotation_about_y(kPi * 0.4f).transpose();
  EXPECT_DOUBLE_EQ(flip_rate(predicted, truth), 0.25);
}

TEST(RotationErrors, SeeATurnedHeadOnlyAtTheHead) {
  const std::vector<Rotations> truth(2, identity_rotations());
  auto predicted = truth;
  for (auto& frame : predicted) frame[Head] = rotation_about_y(kPi / 6);
  const RotationError error = rotation_error(predicted, truth);
  EXPECT_NEAR(error.head_deg, 30, 1e-3);
  EXPECT_NEAR(error.all_deg, 30.0 / 22, 1e-3);
  EXPECT_NEAR(error.wrist_deg, 0, 1e-3);
}

TEST(RotationErrors, PassFromTheShoulderToTheWrist) {
  const std::vector<Rotations> truth(1, identity_rotations());
  auto predicted = truth;
  predicted[0][LeftShoulder] = rotation_about_y(kPi / 3);  // one of the two wrists follows
  EXPECT_NEAR(rotation_error(predicted, truth).wrist_deg, 30, 1e-3);
}

TEST(RotationErrors, PassFromTheKneeToTheFoot) {
  const std::vector<Rotations> truth(1, identity_rotations());
  auto predicted = truth;
  predicted[0][RightKnee] = rotation_about_y(kPi / 2);
  EXPECT_NEAR(rotation_error(predicted, truth).foot_deg, 45, 1e-3);
}

TEST(BoneDrift, IsDeviationOverMean) {
  JointSequence x(2, Joints::Zero());
  for (int j = 1; j < kJointCount; ++j)
    for (auto& frame : x) frame.row(j) = frame.row(kParents[j]) + Eigen::RowVector3f(0, 1, 0);
  EXPECT_NEAR(bone_drift(x), 0, 1e-7);
  x[0](Head, 1) += 0.5f;  // lengths 1.5 and 1: mean 1.25, deviation 0.25
  EXPECT_NEAR(bone_drift(x), 0.2 / 21, 1e-6);
}

TEST(FootSkate, IsTheSpeedOfAFootNearTheFloor) {
  Joints still = standing(), next = standing();
  next.row(LeftFoot) += Eigen::RowVector3f(0.003f, 0, 0.004f);  // 5 mm in 1/30 s; the other foot stands
  EXPECT_NEAR(foot_skate({still, next}, 30), 0.075, 1e-5);
}

TEST(FootSkate, LeavesOutAFootInTheAir) {
  Joints still = standing(), next = standing();
  still(LeftFoot, 1) = next(LeftFoot, 1) = 0.2f;
  next(LeftFoot, 0) += 1;
  EXPECT_NEAR(foot_skate({still, next}, 30), 0, 1e-7);
  still(RightFoot, 1) = 0.2f;
  EXPECT_TRUE(std::isnan(foot_skate({still, next}, 30)));
}

TEST(Jerk, IsTheThirdDerivativeOfACubic) {
  JointSequence x(6, Joints::Zero());
  for (int t = 0; t < 6; ++t)
    x[t].col(2).setConstant(std::pow(t / 10.0f, 3.0f));  // z = t^3, third derivative 6
  EXPECT_NEAR(jerk(x, 10), 6, 1e-3);
  EXPECT_TRUE(std::isnan(jerk({x[0], x[1], x[2]}, 10)));
}

TEST(ScaledJoints, HipsLieOnHipsAndTheScaleFitsBest) {
  Joints truth = Joints::Random();
  Joints predicted = 3 * truth;
  predicted.rowwise() += Eigen::RowVector3f(5, -2, 1);
  EXPECT_LT(mean_joint_error(scaled_joints({predicted}, {truth}), {truth}), 1e-5);
  Joints moved = truth;
  moved(Head, 0) += 0.22f;
  EXPECT_NEAR(mean_joint_error(scaled_joints({moved}, {truth}), {truth}), 0.01, 0.005);
}

}  // namespace
}  // namespace understudy
