#include "app/run/evaluator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

double value(const Metrics& metrics, const std::string& key) {
  for (const auto& [name, number] : metrics)
    if (name == key) return number;
  return NAN;
}

Joints some_joints(int t) {
  Joints x;
  for (int j = 0; j < kJointCount; ++j)
    x.row(j) << std::sin(1.7f * j), 0.1f * j + 0.01f * t * t, std::cos(2.3f * j);
  return x;
}

Truth truth_of(int frames) {
  Truth truth;
  truth.frames = frames;
  truth.vertex_count = 8;
  for (int t = 0; t < frames; ++t) {
    truth.joints.push_back(some_joints(t));
    truth.source_joints.push_back(some_joints(t + 5));
    truth.rotations.push_back(identity_rotations());
    for (int v = 0; v < 8; ++v)
      for (const float x : {0.1f * v, 0.01f * v * v, 1.0f + 0.02f * t}) truth.vertices.push_back(x);
  }
  return truth;
}

/// The truth itself, every joint and vertex moved by `by` metres along z.
Metrics evaluated(const Truth& truth, int frames, float by) {
  Evaluator evaluator(30, &truth, nullptr);
  for (int t = 0; t < frames; ++t) {
    const Eigen::RowVector3f shift(0, 0, by);
    const Points vertices = truth.frame_vertices(t).rowwise() + shift;
    const Joints joints = truth.joints[t].rowwise() + shift,
                 source = truth.source_joints[t].rowwise() + shift;
    evaluator.push({&vertices, &joints, &truth.rotations[t], &source, nullptr, nullptr});
  }
  return evaluator.metrics();
}

TEST(Evaluator, FindsNoFaultWithTheTruth) {
  const Truth truth = truth_of(4);
  const Metrics metrics = evaluated(truth, 4, 0);
  for (const char* key :
       {"mpjpe_m", "pa_mpjpe_m", "acc", "pa_acc", "mpvd_m", "pa_mpvd_m", "medl_mm", "rot_deg", "head_deg",
        "wrist_deg", "foot_deg", "extraction_mpjpe_mm", "extraction_swap_rate", "extraction_flip_rate"})
    EXPECT_NEAR(value(metrics, key), 0, 1e-4) << key;
}

TEST(Evaluator, TellsAShiftInTheRightUnits) {
  const Metrics metrics = evaluated(truth_of(4), 4, 0.05f);
  EXPECT_NEAR(value(metrics, "mpjpe_m"), 0.05, 1e-5);
  EXPECT_NEAR(value(metrics, "mpvd_m"), 0.05, 1e-5);
  EXPECT_NEAR(value(metrics, "extraction_mpjpe_mm"), 50, 1e-2);
  EXPECT_NEAR(value(metrics, "pa_mpjpe_m"), 0, 1e-5);
}

TEST(Evaluator, LeavesOutWhatCannotBeTold) {
  const Metrics metrics = evaluated(truth_of(2), 2, 0);  // two frames have no acceleration
  EXPECT_TRUE(std::isnan(value(metrics, "acc")));
  EXPECT_TRUE(std::isnan(value(metrics, "jerk")));
  EXPECT_TRUE(std::isnan(value(metrics, "inside")));
}

TEST(Evaluator, RefusesMissingAndSurplusFrames) {
  EXPECT_THROW(evaluated(truth_of(4), 3, 0), Error);
  const Truth truth = truth_of(1);
  Evaluator evaluator(30, &truth, nullptr);
  evaluator.push({});
  EXPECT_THROW(evaluator.push({}), Error);
}

TEST(Evaluator, WorksWithoutTruth) {
  Evaluator evaluator(30, nullptr, nullptr);
  const Joints joints = some_joints(0);
  evaluator.push({nullptr, &joints, nullptr, &joints, nullptr, nullptr});
  const Metrics metrics = evaluator.metrics();
  EXPECT_EQ(value(metrics, "bone_drift"), 0);
  EXPECT_TRUE(std::isnan(value(metrics, "mpjpe_m")));
}

TEST(MeanMetrics, AreOverTheCasesThatHaveThem) {
  const Metrics mean = mean_metrics({{{"a", 1}, {"b", 5}}, {{"a", 3}}});
  EXPECT_DOUBLE_EQ(value(mean, "a"), 2);
  EXPECT_DOUBLE_EQ(value(mean, "b"), 5);
}

}  // namespace
}  // namespace understudy::app
