#include "retarget/pipeline/joint_filter.hpp"

#include <gtest/gtest.h>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

Joints danced(int i) {
  return forward_kinematics(human_rest(), dance(static_cast<float>(i) / 30)).joints;
}

float error(const Joints& a, const Joints& b) {
  return (a - b).rowwise().norm().mean();
}

TEST(JointFilter, TakesNoiseOut) {
  JointFilter filter;
  Rng rng(1);
  float before = 0, after = 0;
  for (int i = 0; i < 120; ++i) {
    Joints noisy = danced(i);
    for (Eigen::Index k = 0; k < noisy.size(); ++k) noisy.data()[k] += 0.02f * rng.normal();
    const Joints smooth = filter.push(seen(noisy), 1 / 30.0f).joints;
    if (i < 20) continue;
    before += error(noisy, danced(i));
    after += error(smooth, danced(i));
  }
  EXPECT_LT(after, 0.85f * before);
}

TEST(JointFilter, LagsLessThanAFrameBehindTrueJoints) {
  JointFilter filter;
  float own = 0, older = 0;
  for (int i = 0; i < 60; ++i) {
    const Joints out = filter.push(seen(danced(i)), 1 / 30.0f).joints;
    if (i < 5) continue;
    own += error(out, danced(i));
    older += error(out, danced(i - 1));
  }
  EXPECT_LT(own, 0.35f * older);
}

Rotations turned(int i) {
  return forward_kinematics(human_rest(), dance(static_cast<float>(i) / 30)).global;
}

float error(const Rotations& a, const Rotations& b) {
  float sum = 0;
  for (size_t j = 0; j < kJointCount; ++j) sum += geodesic_angle(a[j], b[j]) / kJointCount;
  return sum;
}

Extraction seen_turned(int i) {
  Extraction frame = seen(danced(i));
  frame.global = turned(i);
  return frame;
}

TEST(JointFilter, TakesNoiseOutOfSeenRotations) {
  JointFilter filter;
  Rng rng(1);
  float before = 0, after = 0;
  for (int i = 0; i < 120; ++i) {
    Extraction noisy = seen_turned(i);
    for (Mat3& R : *noisy.global)
      R = rotation_from_axis_angle(0.06f * Vec3(rng.normal(), rng.normal(), rng.normal())) * R;
    const Extraction smooth = filter.push(noisy, 1 / 30.0f);
    if (i < 20) continue;
    before += error(*noisy.global, turned(i));
    after += error(*smooth.global, turned(i));
  }
  EXPECT_LT(after, 0.9f * before);
}

TEST(JointFilter, LagsLessThanAFrameBehindTrueRotations) {
  JointFilter filter;
  float own = 0, older = 0;
  for (int i = 0; i < 60; ++i) {
    const Extraction out = filter.push(seen_turned(i), 1 / 30.0f);
    if (i < 5) continue;
    own += error(*out.global, turned(i));
    older += error(*out.global, turned(i - 1));
  }
  EXPECT_LT(own, 0.35f * older);
}

TEST(JointFilter, RotationsBeginAnewAfterFramesWithoutThem) {
  JointFilter filter;
  for (int i = 0; i < 5; ++i) filter.push(seen_turned(i), 1 / 30.0f);
  EXPECT_FALSE(filter.push(seen(danced(5)), 1 / 30.0f).global);
  EXPECT_EQ(error(*filter.push(seen_turned(40), 1 / 30.0f).global, turned(40)), 0);
}

TEST(JointFilter, ExchangesSidesBackWhenTheEvidenceIsWeak) {
  JointFilter filter;
  for (int i = 0; i < 10; ++i) filter.push(seen(danced(i)), 1 / 30.0f);
  Extraction swapped = seen(danced(10));
  for (const int j : {LeftHip, LeftKnee, LeftAnkle, LeftFoot})
    swapped.joints.row(j).swap(swapped.joints.row(kMirror[j]));
  swapped.confidence.setConstant(0.5f);
  EXPECT_LT(error(filter.push(swapped, 1 / 30.0f).joints, danced(10)), 0.03f);
  EXPECT_TRUE(filter.repaired());
}

TEST(JointFilter, BelievesAConfidentFrame) {
  JointFilter filter;
  for (int i = 0; i < 10; ++i) filter.push(seen(danced(i)), 1 / 30.0f);
  Extraction swapped = seen(danced(10));
  for (int j = 0; j < kJointCount; ++j) swapped.joints.row(j) = danced(10).row(kMirror[j]);
  filter.push(swapped, 1 / 30.0f);
  EXPECT_FALSE(filter.repaired());
}

TEST(JointFilter, PassesThroughWhenTurnedOff) {
  JointFilterOptions options;
  options.repair_swaps = options.smooth = options.fix_lengths = false;
  JointFilter filter(options);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(filter.push(seen(danced(i)), 0.1f).joints, danced(i));
}

TEST(JointFilter, PullsBonesToTheirMedianLengths) {
  JointFilterOptions options;
  options.smooth = false;
  JointFilter filter(options);
  for (int i = 0; i < 20; ++i) filter.push(seen(danced(i)), 1 / 30.0f);
  Extraction stretched = seen(danced(20));
  stretched.joints.row(LeftWrist) +=
      0.5f * (stretched.joints.row(LeftWrist) - stretched.joints.row(LeftElbow));
  stretched.confidence[LeftWrist] = 0.1f;
  const auto lengths = bone_lengths(filter.push(stretched, 1 / 30.0f).joints);
  EXPECT_NEAR(lengths[LeftWrist], bone_lengths(human_rest())[LeftWrist], 0.03f);
}

}  // namespace
}  // namespace understudy
