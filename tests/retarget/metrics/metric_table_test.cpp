#include "retarget/metrics/metric_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

Joints spread(int t, float by) {
  Joints x;
  for (int j = 0; j < kJointCount; ++j)
    x.row(j) << std::sin(1.7f * j) + by * j, 0.1f * j + 0.01f * t * t, std::cos(2.3f * j + by * t);
  return x;
}

MetricSequence moving(float by) {
  MetricSequence s;
  for (int t = 0; t < 6; ++t) {
    s.joints.push_back(spread(t, by));
    s.source_joints.push_back(spread(t + 3, by));
    s.raw_joints.push_back(spread(t + 3, 2 * by));
    s.rotations.push_back(identity_rotations());
    for (Mat3& R : s.rotations.back()) R = rotation_from_axis_angle(Vec3(by * t, 0, by));
    s.confidence.push_back(0.5f);
  }
  return s;
}

TEST(MetricTable, EveryMetricHasAKeyOfItsOwnAndWords) {
  std::set<std::string> keys, labels;
  for (const Metric& metric : metric_table()) {
    EXPECT_TRUE(keys.insert(metric.key).second) << metric.key;
    EXPECT_TRUE(labels.insert(metric.label).second) << metric.label;
    EXPECT_TRUE(metric.digits >= 0 && metric.digits <= 6) << metric.key;
    EXPECT_EQ(find_metric(metric.key), &metric);
    EXPECT_TRUE(metric.needs != 0 || (!metric.of && !metric.series)) << metric.key;
  }
  EXPECT_EQ(find_metric("nothing"), nullptr);
}

TEST(MetricTable, IsAskedOnlyWhereAllThatItNeedsIsKnown) {
  const MetricSequence p = moving(0.01f), q = moving(0);
  EXPECT_TRUE(is_known(*find_metric("mpjpe_m"), p, q));
  EXPECT_FALSE(is_known(*find_metric("mpjpe_m"), p, {}));
  EXPECT_FALSE(is_known(*find_metric("mpjpe_m"), {}, q));
  EXPECT_TRUE(is_known(*find_metric("bone_drift"), p, {}));
  EXPECT_FALSE(is_known(*find_metric("confidence"), {}, {}));
  MetricSequence half = p;
  half.has_legs = false;
  EXPECT_TRUE(is_known(*find_metric("foot_skate"), p, {}));
  EXPECT_FALSE(is_known(*find_metric("foot_skate"), half, {}));
}

TEST(MetricTable, FiguresOfFramesHaveTheWholesMean) {
  const MetricSequence p = moving(0.01f), q = moving(0);
  for (const char* const key :
       {"mpjpe_m", "pa_mpjpe_m", "rot_deg", "wrist_deg", "extraction_mpjpe_mm", "extraction_swap_rate"}) {
    const Metric& metric = *find_metric(key);
    const auto frames = per_frame_figures(metric, p, q, 6, 30);
    EXPECT_NEAR(std::accumulate(frames.begin(), frames.end(), 0.0) / 6, metric.of(p, q, 30), 1e-4) << key;
  }
}

TEST(MetricTable, FramesWithoutTheNeighboursThatAFigureNeedsSayNothing) {
  const MetricSequence p = moving(0.01f), q = moving(0);
  const auto silent = [&](const char* key) {
    std::vector<int> frames;
    const auto values = per_frame_figures(*find_metric(key), p, q, 6, 30);
    for (int t = 0; t < 6; ++t)
      if (!std::isfinite(values[static_cast<size_t>(t)])) frames.push_back(t);
    return frames;
  };
  EXPECT_EQ(silent("jerk"), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(silent("acc"), (std::vector<int>{0, 5}));
  EXPECT_EQ(silent("bone_drift"), std::vector<int>{});
  EXPECT_EQ(silent("mpjpe_m"), std::vector<int>{});
}

}  // namespace
}  // namespace understudy
