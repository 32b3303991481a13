#include "retarget/style/judged_channels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// Some joints turn about all axes, each in its own time.
std::vector<Rotations> moving(size_t frames) {
  std::vector<Rotations> local(frames, identity_rotations());
  for (size_t t = 0; t < frames; ++t)
    for (int j = 0; j < kJointCount; ++j) {
      const float at = 0.07f * static_cast<float>(t) + static_cast<float>(j);
      local[t][static_cast<size_t>(j)] = rotation_from_axis_angle(
          Vec3(0.3f * std::sin(at), 0.2f * std::cos(2 * at), 0.4f * std::sin(3 * at)));
    }
  return local;
}

TEST(JudgedChannels, AreOfTrunkHeadAndArmsAndOfLegsWhereAskedFor) {
  for (const bool legs : {false, true}) {
    const std::vector<int> joints = judged_joints(legs);
    for (const int j : {LeftAnkle, RightAnkle, LeftFoot, RightFoot, LeftWrist, RightWrist})
      EXPECT_EQ(std::count(joints.begin(), joints.end(), j), 0);
    for (const int j : {LeftHip, RightHip, LeftKnee, RightKnee})
      EXPECT_EQ(std::count(joints.begin(), joints.end(), j), legs ? 1 : 0);
    EXPECT_EQ(judged_channels(moving(7), legs).cols(), static_cast<Eigen::Index>(3 * joints.size()));
  }
}

TEST(JudgedChannels, DoNotKnowWhereSomebodyFaces) {
  std::vector<Rotations> turned = moving(40);
  for (size_t t = 0; t < turned.size(); ++t)
    turned[t][Pelvis] = rotation_about_y(0.1f * static_cast<float>(t)) * turned[t][Pelvis];
  EXPECT_TRUE(judged_channels(turned, true).isApprox(judged_channels(moving(40), true), 1e-3f));
}

TEST(JudgedChannels, AreMirroredAsPosesAre) {
  std::vector<Rotations> local = moving(20), mirror;
  for (const Rotations& pose : local) mirror.push_back(mirrored({pose, Vec3::Zero()}).local);
  for (const bool legs : {false, true})
    EXPECT_TRUE(
        mirrored_channels(judged_channels(local, legs), legs).isApprox(judged_channels(mirror, legs), 1e-3f));
}

TEST(JudgedChannels, ThatMoveOnOneSideAreUsedOfBoth) {
  std::vector<Rotations> local(30, identity_rotations());
  for (size_t t = 0; t < local.size(); ++t) {
    const float angle = std::sin(0.3f * static_cast<float>(t));
    local[t][LeftElbow] = rotation_from_axis_angle(Vec3(0, 0.3f * angle, 0));
    local[t][Neck] = rotation_from_axis_angle(Vec3(0.01f * angle, 0, 0));
  }
  const std::vector<int> joints = judged_joints(false);
  const std::vector<int> used = moving_channels({judged_channels(local, false)}, false);
  ASSERT_EQ(used.size(), 2u);
  for (const int c : used) {
    EXPECT_EQ(c % 3, 1);
    const int joint = joints[static_cast<size_t>(c / 3)];
    EXPECT_TRUE(joint == LeftElbow || joint == RightElbow) << joint;
  }
  EXPECT_THROW(moving_channels({}, false), Error);
}

TEST(Coordination, IsTheSameWhateverTheOffsetTheGainAndTheRate) {
  const RowMatrix rows = judged_channels(moving(50), false);
  RowMatrix other = resampled(rows, 0, 49, 99);  // half as fast: every other frame lies between two
  for (Eigen::Index c = 0; c < other.cols(); ++c)
    other.col(c) =
        (other.col(c).array() * (0.5f + 0.1f * static_cast<float>(c)) + 0.02f * static_cast<float>(c));
  const RowMatrix coordination = coordination_of(rows);
  EXPECT_EQ(coordination.rows(), kCoordinationFrames);
  EXPECT_LT((coordination_of(other) - coordination).cwiseAbs().maxCoeff(), 1e-2f);
  EXPECT_LT(coordination.colwise().mean().cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(Coordination, OfWhatStandsStillOrIsOneFrameIsNothing) {
  for (const Eigen::Index frames : {1, 200})
    EXPECT_LT(coordination_of(RowMatrix::Constant(frames, 3, 0.7f)).cwiseAbs().maxCoeff(), 0.1f);
  EXPECT_THROW(coordination_of(RowMatrix(0, 3)), Error);
}

}  // namespace
}  // namespace understudy
