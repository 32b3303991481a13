#include "app/run/evaluator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

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

TEST(Evaluator, ComparesTheLowestVerticesOfTargetAndScan) {
  Evaluator evaluator(30, nullptr, nullptr);
  for (const float height : {0.01f, 0.012f, 0.5f}) {  // half a metre in one frame is no matter
    Points vertices(3, 3);
    vertices << 0, 1, 0, 0, height, 0, 0, 2, 0;
    Mesh scan;
    scan.vertices = vertices.array() + 1;
    scan.vertices.col(1) << 1, 0.02f, NAN;
    evaluator.push({&vertices, nullptr, nullptr, nullptr, nullptr, &scan});
    EXPECT_NEAR(evaluator.last().at("lowest_gap_mm"), std::abs(1000 * height - 20), 1e-3);
  }
  EXPECT_NEAR(value(evaluator.metrics(), "lowest_gap_mm"), 10, 1e-3);
}

TEST(Evaluator, JudgesASourceByATruthThatComesWithItsFrames) {
  Evaluator evaluator(30, nullptr, nullptr);
  for (int t = 0; t < 3; ++t) {
    Extraction truth;
    truth.joints = some_joints(t);
    truth.global = identity_rotations();
    Joints seen = truth.joints;
    seen.row(LeftKnee) += Eigen::RowVector3f(0, 0, 0.08f);  // one of the eight ends of limbs' bones
    Rotations turned = identity_rotations();
    turned[Head] = rotation_about_y(kPi / 6);
    EvaluatedFrame frame;
    frame.source_joints = &seen;
    frame.rotations = &turned;
    frame.truth = &truth;
    evaluator.push(frame);
  }
  const Metrics metrics = evaluator.metrics();
  EXPECT_NEAR(value(metrics, "extraction_limb_mm"), 10, 1e-3);
  EXPECT_NEAR(value(metrics, "extraction_mpjpe_mm"), 80.0 / kJointCount, 1e-3);
  EXPECT_NEAR(value(metrics, "head_deg"), 30, 1e-3);
  EXPECT_NEAR(value(metrics, "wrist_deg"), 0, 1e-3);
}

TEST(Evaluator, TellsOfARegisteredSurface) {
  // A dense cloud about a T-pose, turned about y as a whole by 10 degrees a frame; the skeleton turns by 7.
  Rng rng(3);
  Points body(20000, 3);
  for (Eigen::Index v = 0; v < body.rows(); ++v)
    body.row(v) << rng.uniform(-0.9f, 0.9f), rng.uniform(-1.0f, 0.8f), rng.uniform(-0.1f, 0.2f);
  Evaluator evaluator(30, nullptr, nullptr);
  for (int t = 0; t < 3; ++t) {
    const Points vertices = body * rotation_about_y(kPi / 18 * t).transpose();
    Rotations local = identity_rotations();
    local[Pelvis] = rotation_about_y(7 * kPi / 180 * t);
    const Joints joints = human_rest() * rotation_about_y(kPi / 18 * t).transpose();
    EvaluatedFrame frame;
    frame.source_joints = &joints;
    frame.rotations = &local;
    frame.registered = &vertices;
    evaluator.push(frame);
  }
  EXPECT_NEAR(value(evaluator.metrics(), "registered_rot_deg"), 3, 0.05);  // 0, 3 and 6
  EXPECT_NEAR(value(evaluator.metrics(), "registered_const_mm"), 0, 0.1);
  EXPECT_GE(evaluator.registered().parts().size(), 12u);
}

TEST(Evaluator, TellsWhatOfSeenJointsIsRight) {
  Truth truth;
  truth.frames = 1;
  truth.source_joints = {some_joints(0)};
  truth.source_seen = {SeenJoints::Ones()};
  truth.source_seen[0].tail<11>().setZero();
  Joints seen = some_joints(0);
  seen.bottomRows<11>().array() += 3;
  const SeenJoints visibility = SeenJoints::Ones();
  Evaluator evaluator(30, &truth, nullptr);
  EvaluatedFrame frame;
  frame.source_joints = &seen;
  frame.visibility = &visibility;
  evaluator.push(frame);
  const Metrics metrics = evaluator.metrics();
  EXPECT_EQ(value(metrics, "extraction_seen_mm"), 0);
  EXPECT_EQ(value(metrics, "visibility_right"), 0.5);
  EXPECT_GT(value(metrics, "extraction_mpjpe_mm"), 1000);
  EXPECT_TRUE(std::isnan(value(metrics, "points_owner_right")));
}

TEST(Evaluator, TellsWhoIsInAScene) {
  Truth truth;
  truth.frames = 1;
  truth.scene = {{{0, 0, 0, kNobodysPoint}, {{some_joints(0), SeenJoints::Ones(), false}}}};
  Evaluator evaluator(30, &truth, nullptr);
  const PredictedPeople people{{5, 5, 5, 5}, {{5, some_joints(0)}}};
  EvaluatedFrame frame;
  frame.people = &people;
  evaluator.push(frame);
  evaluator.push_alone(0, 0, some_joints(0));
  EXPECT_EQ(value(evaluator.metrics(), "points_owner_right"), 0.75);
  EXPECT_EQ(value(evaluator.metrics(), "people_alone_mm"), 0);
  EXPECT_THROW(evaluator.push_alone(0, 1, some_joints(0)), Error);
}

TEST(Evaluator, LeavesOutFiguresOfLegsThatAreNotSeen) {
  const Joints joints = some_joints(0);
  const Points vertices = joints;
  const auto metrics_of = [&](LimbSight leg) {
    Evaluator evaluator(30, nullptr, nullptr);
    for (int t = 0; t < 4; ++t) {
      EvaluatedFrame frame{&vertices, &joints, nullptr, &joints, nullptr, nullptr};
      frame.limbs[2] = t == 0 ? LimbSight::Seen : leg;
      evaluator.push(frame);
    }
    return evaluator.metrics();
  };
  const Metrics whole = metrics_of(LimbSight::Seen), half = metrics_of(LimbSight::EndUnseen);
  for (const char* key : {"floor_mm", "floor_worst_mm", "bone_asymmetry"}) {
    EXPECT_FALSE(std::isnan(value(whole, key))) << key;
    EXPECT_TRUE(std::isnan(value(half, key))) << key;
  }
  EXPECT_EQ(value(half, "bone_drift"), 0);
}

TEST(Evaluator, LooksForJointsInsideOnlyWhereTheyAreSeen) {
  Joints joints = Joints::Zero();
  for (const int j : {LeftElbow, LeftWrist}) joints(j, 0) = 5;  // hung where nothing was seen
  Mesh box;
  box.vertices.resize(600, 3);
  Rng rng(1);
  for (Eigen::Index v = 0; v < 600; ++v) {
    Vec3 p(rng.uniform(-0.3f, 0.3f), rng.uniform(-0.3f, 0.3f), rng.uniform(-0.3f, 0.3f));
    p[rng.below(3)] = rng.chance(0.5f) ? -0.3f : 0.3f;
    box.vertices.row(v) = p.transpose();
  }
  const auto inside = [&](LimbSight arm) {
    Evaluator evaluator(30, nullptr, nullptr);
    EvaluatedFrame frame{nullptr, &joints, nullptr, &joints, nullptr, &box};
    frame.limbs[0] = arm;
    evaluator.push(frame);
    return value(evaluator.metrics(), "inside");
  };
  EXPECT_EQ(inside(LimbSight::Unseen), 1);
  EXPECT_LT(inside(LimbSight::Seen), 1);
}

TEST(MeanMetrics, AreOverTheCasesThatHaveThem) {
  const Metrics mean = mean_metrics({{{"a", 1}, {"b", 5}}, {{"a", 3}}});
  EXPECT_DOUBLE_EQ(value(mean, "a"), 2);
  EXPECT_DOUBLE_EQ(value(mean, "b"), 5);
}

}  // namespace
}  // namespace understudy::app
