#include <gtest/gtest.h>

#include "retarget/metrics/metric_table.hpp"

namespace understudy {
namespace {

double asymmetry(const MetricSequence& p) {
  return find_metric("bone_asymmetry")->of(p, {}, 30);
}

TEST(BoneAsymmetry, IsTheMeanDifferenceOfThePairsOverTheirLength) {
  Joints longer = Joints::Zero();  // all bones of length 0 but these
  longer.row(LeftWrist) << 0, 0, 0.3f;
  longer.row(RightWrist) << 0, 0.2f, 0;
  MetricSequence p;
  p.source_joints = {longer};
  EXPECT_NEAR(asymmetry(p), 0.1 / 0.25 / 8, 1e-6);
  p.source_joints.push_back(Joints::Zero());
  EXPECT_NEAR(asymmetry(p), 0.1 / 0.25 / 16, 1e-6);
}

TEST(BoneAsymmetry, IsZeroForMirroredSidesHoweverTheyAreTurned) {
  Joints joints = Joints::Zero();
  joints.row(LeftHip) << 0.1f, 0, 0;
  joints.row(RightHip) << 0, 0, -0.1f;
  joints.row(LeftKnee) << 0.1f, -0.4f, 0;
  joints.row(RightKnee) << 0.4f, 0, -0.1f;
  MetricSequence p;
  p.source_joints = {joints};
  for (const int j : {LeftAnkle, LeftFoot}) p.source_joints[0].row(j) = joints.row(LeftKnee);
  for (const int j : {RightAnkle, RightFoot}) p.source_joints[0].row(j) = joints.row(RightKnee);
  EXPECT_NEAR(asymmetry(p), 0, 1e-6);
}

}  // namespace
}  // namespace understudy
