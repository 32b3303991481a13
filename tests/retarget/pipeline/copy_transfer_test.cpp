#include "retarget/pipeline/copy_transfer.hpp"

#include <gtest/gtest.h>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

float worst_angle_deg(const Rotations& a, const Rotations& b) {
  float worst = 0;
  for (int j = 0; j < kJointCount; ++j) worst = std::max(worst, geodesic_angle(a[j], b[j]));
  return worst * 180 / kPi;
}

TEST(CopyTransfer, LeavesATPoseATPose) {
  CopyTransfer copy;
  copy.reset(other_body());
  EXPECT_LT(worst_angle_deg(copy.push(seen(human_rest()), 1 / 30.0f), identity_rotations()), 0.1f);
}

TEST(CopyTransfer, PutsTheSourcesOwnBodyIntoTheSourcesPose) {
  CopyTransfer copy;
  copy.reset(human_rest());
  for (int i = 0; i < 30; ++i) {
    const Pose truth = dance(static_cast<float>(i) / 30);
    const Joints joints = forward_kinematics(human_rest(), truth).joints;
    const Pose found{copy.push(seen(joints), 1 / 30.0f), truth.root};
    EXPECT_LT((forward_kinematics(human_rest(), found).joints - joints).rowwise().norm().maxCoeff(), 0.012f)
        << i;
  }
}

TEST(CopyTransfer, FindsTheTwistOfBentLimbsFromTheirHinges) {
  CopyTransfer copy;
  copy.reset(human_rest());
  const Pose truth = dance(1);
  const Joints joints = forward_kinematics(human_rest(), truth).joints;
  Rotations found;
  for (int i = 0; i < 5; ++i)
    found = copy.push(seen(joints), 1 / 30.0f);  // the axis settles within a few frames
  const auto want = forward_kinematics(human_rest(), truth).global;
  const auto got = forward_kinematics(human_rest(), Pose{found, Vec3::Zero()}).global;
  for (const int j :
       {LeftHip, RightHip, LeftKnee, RightKnee, LeftShoulder, RightShoulder, LeftElbow, RightElbow})
    EXPECT_LT(geodesic_angle(want[j], got[j]) * 180 / kPi, 5.0f) << kJointNames[j];
}

TEST(CopyTransfer, TakesTheTwistSeenWherePositionsCannotTell) {
  CopyTransfer copy;
  copy.reset(human_rest());
  const Pose truth = dance(0.7f);
  const PosedSkeleton posed = forward_kinematics(human_rest(), truth);
  Extraction source = seen(posed.joints);
  source.global = posed.global;
  EXPECT_LT(worst_angle_deg(copy.push(source, 1 / 30.0f), truth.local), 5.0f);
}

TEST(CopyTransfer, TurnsWithTheSourcesHeading) {
  const Mat3 turn = rotation_about_y(2.1f);
  CopyTransfer a, b;
  a.reset(other_body());
  b.reset(other_body());
  for (int i = 0; i < 20; ++i) {
    const Joints joints = forward_kinematics(human_rest(), dance(static_cast<float>(i) / 10)).joints;
    Rotations expected = a.push(seen(joints), 0.1f);
    expected[Pelvis] = turn * expected[Pelvis];
    EXPECT_LT(worst_angle_deg(b.push(seen(joints * turn.transpose()), 0.1f), expected), 0.1f);
  }
}

TEST(CopyTransfer, IgnoresTheSourcesSizeAndPlace) {
  CopyTransfer a, b;
  a.reset(other_body());
  b.reset(other_body());
  const Joints joints = forward_kinematics(human_rest(), dance(1)).joints;
  Joints moved = 1.7f * joints;
  moved.rowwise() += Eigen::RowVector3f(3, 1, -2);
  EXPECT_LT(worst_angle_deg(a.push(seen(joints), 0.1f), b.push(seen(moved), 0.1f)), 0.05f);
}

TEST(CopyTransfer, StaysSteadyWhileAnArmIsStraight) {
  CopyTransfer copy;
  copy.reset(human_rest());
  Rng rng(3);
  Rotations last;
  float worst = 0;
  for (int i = 0; i < 60; ++i) {
    Pose pose;  // bends, straightens, and stays straight with 3 mm of noise
    const float bend = std::max(0.0f, 1.2f - 0.06f * static_cast<float>(i));
    pose.local[LeftElbow] = rotation_from_axis_angle(bend * Vec3(0, -0.87f, 0.49f));
    Joints joints = forward_kinematics(human_rest(), pose).joints;
    for (Eigen::Index k = 0; k < joints.size(); ++k) joints.data()[k] += 0.003f * rng.normal();
    const Rotations now = copy.push(seen(joints), 1 / 30.0f);
    if (i > 0) worst = std::max(worst, geodesic_angle(last[LeftShoulder], now[LeftShoulder]));
    last = now;
  }
  EXPECT_LT(worst * 180 / kPi, 12.0f);
}

TEST(CopyTransfer, RefusesJointsThatAreNotNumbers) {
  CopyTransfer copy;
  copy.reset(human_rest());
  Joints joints = human_rest();
  joints(3, 1) = NAN;
  EXPECT_THROW(copy.push(seen(joints), 0.1f), Error);
}

TEST(CopyTransfer, SurvivesJointsThatFallTogether) {
  CopyTransfer copy;
  copy.reset(human_rest());
  const Rotations found = copy.push(seen(Joints::Zero()), 0.1f);
  for (const Mat3& R : found) EXPECT_NEAR(R.determinant(), 1, 1e-3f);
}

}  // namespace
}  // namespace understudy
