#include "retarget/metrics/style_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

constexpr double kFps = 60;
Joints who_stands() {
  return forward_kinematics(human_rest(), {identity_rotations(), Vec3(0, 1, 0)}).joints;
}

TEST(StyleMetrics, SwayIsTheRangeThatTheNeckGoesOverThePelvisWhateverTheHeading) {
  for (const float yaw : {0.0f, 1.0f, 2.5f}) {
    JointSequence joints;
    for (int t = 0; t < 120; ++t) {
      Pose pose;
      pose.root = Vec3(0, 1, 0);
      pose.local[Pelvis] = rotation_about_y(yaw);
      pose.local[Spine1] =
          Eigen::AngleAxisf(0.1f * std::sin(2 * kPi * static_cast<float>(t) / 120), Vec3::UnitZ())
              .toRotationMatrix();
      joints.push_back(forward_kinematics(human_rest(), pose).joints);
    }
    EXPECT_NEAR(body_sway_deg(joints, kFps), 2 * 0.1 * 180 / kPi * 0.9, 1.6) << yaw;
  }
}

TEST(StyleMetrics, TheHeadsTurningIsItsSpeedOnTheChest) {
  std::vector<Rotations> local(60, identity_rotations());
  for (size_t t = 0; t < local.size(); ++t) local[t][Head] = rotation_about_y(static_cast<float>(t) * 0.01f);
  EXPECT_NEAR(head_turn_deg_s(local, kFps), 0.01 * kFps * 180 / kPi, 1.5);
}

TEST(StyleMetrics, ThePelvisSpeedIsInLegs) {
  JointSequence joints;
  for (int t = 0; t < 60; ++t)
    joints.emplace_back(who_stands().rowwise() + Vec3(0.01f * static_cast<float>(t), 0, 0).transpose());
  EXPECT_NEAR(pelvis_speed_legs(joints, kFps), 0.6 / static_cast<double>(leg_length(who_stands())), 0.01);
}

TEST(StyleMetrics, GravityIsThatOfTheFlight) {
  for (const double pull : {9.81, 5.0}) {
    JointSequence joints(20, who_stands());
    const double up = 2.5, flight = 2 * up / pull;
    for (double t = 0; t < flight; t += 1 / kFps)
      joints.emplace_back(who_stands().rowwise() +
                          Vec3(0, static_cast<float>(up * t - 0.5 * pull * t * t), 0).transpose());
    joints.insert(joints.end(), 20, who_stands());
    EXPECT_NEAR(flight_gravity(joints, kFps), pull, 0.05 * pull);
  }
  EXPECT_TRUE(std::isnan(flight_gravity(JointSequence(30, who_stands()), kFps)));
}

TEST(StyleMetrics, AWalksCycleIsFoundAtAnyTempo) {
  const Motion walk = builtin_motion("walk", human_rest(), 30);
  JointSequence joints;
  for (const Pose& pose : walk.poses) joints.push_back(forward_kinematics(human_rest(), pose).joints);
  const double cycle = cycle_s(joints, 30);
  EXPECT_GT(cycle, 0.6);
  EXPECT_LT(cycle, 1.6);
  EXPECT_NEAR(cycle_s(joints, 60), cycle / 2, 0.05);
  EXPECT_TRUE(std::isnan(cycle_s(JointSequence(60, who_stands()), 30)));
}

TEST(StyleMetrics, AFootThatSlidesWhileItStandsIsSeen) {
  JointSequence joints;
  for (int t = 0; t < 60; ++t)
    joints.emplace_back(who_stands().rowwise() + Vec3(0, 0, 0.002f * static_cast<float>(t)).transpose());
  EXPECT_NEAR(stance_slide(joints, 60), 0.12, 0.01);
  EXPECT_NEAR(stance_slide(JointSequence(60, who_stands()), 60), 0, 1e-6);
}

TEST(StyleMetrics, ARiseIsReachOverTopSpeed) {
  JointSequence joints;
  for (int t = 0; t <= 60; ++t) {
    Joints one = who_stands();
    one(LeftWrist, 1) += 0.25f * (1 - std::cos(kPi * static_cast<float>(t) / 60));
    joints.push_back(one);
  }
  // 0.5 m within a second along a cosine: the top speed is pi / 2 of the mean one.
  EXPECT_NEAR(rise_s(joints, kFps), 2 / kPi, 0.02);
  EXPECT_TRUE(std::isnan(rise_s(JointSequence(60, who_stands()), kFps)));
}

}  // namespace
}  // namespace understudy
