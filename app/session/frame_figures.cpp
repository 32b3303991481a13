#include "app/session/frame_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/metrics/joint_metrics.hpp"

namespace understudy::app {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A series whose value at frame t is figure(t), for t in first .. count - 1 - last.
Series filled(const std::string& key, size_t count, const std::function<double(size_t)>& figure,
              size_t first = 0, size_t last = 0) {
  Series series = blank_series(key, count);
  for (size_t t = first; t + last < count; ++t) series.values[t] = static_cast<float>(figure(t));
  return series;
}

/// Second difference of joint positions at 30 frames/s around frame t.
Joints bend(const std::vector<Joints>& joints, size_t t, double fps) {
  const float per_frame = static_cast<float>(fps * fps / 900);
  return per_frame * (joints[t + 1] - 2 * joints[t] + joints[t - 1]);
}

/// How far bone lengths are from their mean over time, mean over bones, share of the length.
Series bone_drift_series(const std::vector<KeptSource>& source, size_t count) {
  Eigen::Array<float, kJointCount, 1> usual = Eigen::Array<float, kJointCount, 1>::Zero();
  const auto lengths = [&](size_t t) {
    Eigen::Array<float, kJointCount, 1> result = Eigen::Array<float, kJointCount, 1>::Zero();
    for (int j = 1; j < kJointCount; ++j)
      result[j] = (source[t].joints.row(j) - source[t].joints.row(kParents[j])).norm();
    return result;
  };
  for (size_t t = 0; t < count; ++t) usual += lengths(t) / static_cast<float>(count);
  return filled("bone_drift", count, [&](size_t t) {
    const auto now = lengths(t);
    float sum = 0;
    for (int j = 1; j < kJointCount; ++j)
      if (usual[j] > 1e-4f) sum += std::abs(now[j] - usual[j]) / usual[j];
    return sum / (kJointCount - 1);
  });
}

void add_truth(const FigureInput& input, size_t count, std::vector<Series>& series) {
  const Truth& truth = *input.truth;
  const double fps = input.shown.fps;
  if (truth.joints.size() >= count) {
    series.push_back(filled(
        "mpjpe_m", count, [&](size_t t) { return mean_joint_error({input.joints[t]}, {truth.joints[t]}); }));
    series.push_back(filled("pa_mpjpe_m", count, [&](size_t t) {
      return mean_joint_error(aligned_joints({input.joints[t]}, {truth.joints[t]}), {truth.joints[t]});
    }));
    series.push_back(filled(
        "acc", count,
        [&](size_t t) {
          return (bend(input.joints, t, fps) - bend(truth.joints, t, fps)).rowwise().norm().mean();
        },
        1, 1));
  }
  if (truth.rotations.size() >= count) {
    std::vector<RotationError> errors;
    for (size_t t = 0; t < count; ++t)
      errors.push_back(rotation_error({input.shown.poses[t].local}, {truth.rotations[t]}));
    series.push_back(filled("rot_deg", count, [&](size_t t) { return errors[t].all_deg; }));
    series.push_back(filled("head_deg", count, [&](size_t t) { return errors[t].head_deg; }));
    series.push_back(filled("wrist_deg", count, [&](size_t t) { return errors[t].wrist_deg; }));
    series.push_back(filled("foot_deg", count, [&](size_t t) { return errors[t].foot_deg; }));
  }
  if (truth.source_joints.size() >= count && input.source.size() >= count) {
    series.push_back(filled("extraction_mpjpe_mm", count, [&](size_t t) {
      return 1000 * mean_joint_error({input.source[t].joints}, {truth.source_joints[t]});
    }));
    series.push_back(filled("extraction_swap_rate", count, [&](size_t t) {
      return swap_rate({input.source[t].joints}, {truth.source_joints[t]});
    }));
  }
}

}  // namespace

const std::vector<Series>& known_series() {
  static const std::vector<Series> kSeries = {
      {"confidence", "Confidence", "", false, {}},
      {"extraction_mpjpe_mm", "Extraction error", "mm", true, {}},
      {"extraction_swap_rate", "Left-right swaps", "", true, {}},
      {"mpjpe_m", "MPJPE", "m", true, {}},
      {"pa_mpjpe_m", "PA-MPJPE", "m", true, {}},
      {"acc", "Acceleration error", "m/frame\xC2\xB2", true, {}},
      {"mpvd_m", "MPVD", "m", true, {}},
      {"pa_mpvd_m", "PA-MPVD", "m", true, {}},
      {"medl_mm", "MEDL", "mm", true, {}},
      {"rot_deg", "Rotation error", "deg", true, {}},
      {"head_deg", "Head rotation error", "deg", true, {}},
      {"wrist_deg", "Wrist rotation error", "deg", true, {}},
      {"foot_deg", "Foot rotation error", "deg", true, {}},
      {"bone_drift", "Bone length drift", "", true, {}},
      {"foot_skate", "Foot skate", "m/s", true, {}},
      {"floor_mm", "Floor penetration", "mm", true, {}},
      {"jerk", "Jerk", "m/s\xC2\xB3", true, {}},
      {"self_penetration", "Self-penetration", "", true, {}},
      {"inside", "Joints inside the scan", "", false, {}},
  };
  return kSeries;
}

const std::vector<Series>& known_totals() {
  static const std::vector<Series> kTotals = {
      {"pa_acc", "PA acceleration error", "m/frame\xC2\xB2", true, {}},
      {"extraction_flip_rate", "Front-back flips", "", true, {}},
      {"extraction_raw_mpjpe_mm", "Raw extraction error", "mm", true, {}},
  };
  return kTotals;
}

Series blank_series(const std::string& key, size_t count) {
  const Series* known = find(known_series(), key);
  US_CHECK(known, "there is no figure ", key);
  Series series = *known;
  series.values.assign(count, kNan);
  return series;
}

std::vector<Series> joint_figures(const FigureInput& input) {
  const size_t count = std::min(input.shown.poses.size(), input.joints.size());
  std::vector<Series> series;
  if (input.source.size() >= count) {
    series.push_back(filled("confidence", count, [&](size_t t) { return input.source[t].confidence; }));
    series.push_back(bone_drift_series(input.source, count));
  }
  series.push_back(filled(
      "foot_skate", count,
      [&](size_t t) {
        return foot_skate({input.joints[t], input.joints[t + 1]}, input.shown.fps);
      },
      0, 1));
  series.push_back(filled(
      "jerk", count,
      [&](size_t t) {
        return jerk({input.joints[t], input.joints[t + 1], input.joints[t + 2], input.joints[t + 3]},
                    input.shown.fps);
      },
      0, 3));
  if (input.truth) add_truth(input, count, series);
  return series;
}

}  // namespace understudy::app
