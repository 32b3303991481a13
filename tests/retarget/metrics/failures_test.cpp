#include "retarget/metrics/failures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/metrics/confidence.hpp"

namespace understudy {
namespace {

Joints standing_person() {
  Joints x = Joints::Zero();
  for (int j = 0; j < kJointCount; ++j)
    x.row(j) << (kMirror[j] == j ? 0.f : kMirror[j] > j ? .2f : -.2f), .08f * j, 0;
  return x;
}

FrameFailures evaluated(const JointSequence& seen, const JointSequence& performed,
                        const Rotations& rotations) {
  const JointSequence truth(3, standing_person());
  const std::vector<Rotations> turned(3, rotations), straight(3, identity_rotations());
  return failures_of({seen, truth, performed, truth, turned, straight, 30}).back();
}

FrameFailures expected(std::initializer_list<Failure> failures) {
  FrameFailures frame{};
  for (const Failure f : failures) frame[f] = true;
  return frame;
}

const JointSequence kStill(3, standing_person());

TEST(Failures, FindsNoneInTheTruth) {
  EXPECT_EQ(evaluated(kStill, kStill, identity_rotations()), expected({}));
}

TEST(Failures, TellsSwappedLegsFromALostWrist) {
  JointSequence swapped = kStill, lost = kStill;
  for (const int j : {LeftHip, LeftKnee, LeftAnkle, LeftFoot})
    swapped[2].row(j).swap(swapped[2].row(kMirror[j]));
  lost[2](LeftWrist, 2) += 0.2f;
  EXPECT_EQ(evaluated(swapped, kStill, identity_rotations()), expected({SidesSwapped, HeadingFlipped}));
  EXPECT_EQ(evaluated(lost, kStill, identity_rotations()), expected({LimbLost}));
}

TEST(Failures, TellsAJoltFromASlide) {
  JointSequence jolted = kStill, sliding = kStill;
  jolted[2](Head, 1) += 0.06f;
  for (int t = 0; t < 3; ++t) sliding[t](LeftFoot, 0) += 0.02f * t;  // 0.6 m/s, evenly
  EXPECT_EQ(evaluated(kStill, jolted, identity_rotations()), expected({Jolt}));
  EXPECT_EQ(evaluated(kStill, sliding, identity_rotations()), expected({FootSlides}));
}

TEST(Failures, TellsATwistFromABend) {
  Rotations twisted = identity_rotations(), bent = identity_rotations();
  twisted[LeftElbow] = rotation_from_axis_angle(Vec3(1, 0, 0));
  bent[LeftElbow] = rotation_from_axis_angle(Vec3(0, 1, 0));
  EXPECT_EQ(evaluated(kStill, kStill, twisted), expected({BoneTwisted}));
  EXPECT_EQ(evaluated(kStill, kStill, bent), expected({}));
}

TEST(Confidence, RanksAreWhatCorrelates) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 10, 100, 1000}), 1);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {5, 4, 3, 2}), -1);
  EXPECT_NEAR(rank_correlation({1, 2, 2, 3}, {1, 2, 3, 4}), 0.948683, 1e-6);  // by hand: ranks 0, 1.5, 1.5, 3
  EXPECT_TRUE(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3})));
  // Expected errors that hardly differ say little of what is drawn; those that differ much say nearly all.
  std::vector<double> near, far;
  for (int i = 0; i < 2000; ++i) near.push_back(1 + 1e-4 * i), far.push_back(std::pow(1.01, i));
  EXPECT_LT(best_rank_correlation(near), 0.2);
  EXPECT_GT(best_rank_correlation(far), 0.95);
}

TEST(Confidence, BinsHoldEquallyMany) {
  std::vector<double> confidence, error;
  for (int i = 0; i < 100; ++i) confidence.push_back(i), error.push_back(100 - i);
  const auto table = reliability(confidence, error, 10);
  ASSERT_EQ(table.size(), 10u);
  EXPECT_EQ(table[9].count, 10);
  EXPECT_DOUBLE_EQ(table[9].confidence, 94.5);
  EXPECT_DOUBLE_EQ(table[9].error, 5.5);
}

}  // namespace
}  // namespace understudy
