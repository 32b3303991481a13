#include "app/run/flat_figures.hpp"

#include <cmath>

#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/keypoints/track_jitter.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"

namespace understudy::app {
namespace {

/// Mean and spread of what comes one after the other.
struct Running {
  double sum = 0, squares = 0, count = 0;
  void add(double value) {
    if (std::isfinite(value)) sum += value, squares += value * value, ++count;
  }
  double mean() const { return sum / count; }
  double deviation() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean())); }
};

void add_second_differences(const FlatPose& a, const FlatPose& b, const FlatPose& c, Running& to) {
  for (int point = 0; point < kBodyPoints; ++point)
    if (a.has(point) && b.has(point) && c.has(point))
      to.add(static_cast<double>((a.at(point) - 2 * b.at(point) + c.at(point)).norm()));
}

void add_known(Metrics& metrics, const char* key, double value) {
  if (std::isfinite(value)) metrics.emplace_back(key, value);
}

}  // namespace

const FlatFigure* find_flat_figure(const std::string& key) {
  for (const FlatFigure& figure : kFlatFigures)
    if (key == figure.key) return &figure;
  return nullptr;
}

double length_drift(const std::vector<FlatPose>& poses, const LengthReader& lengths) {
  std::array<Running, kFlatBoneCount> told;
  for (const FlatPose& pose : poses) {
    if ((seen_lengths(pose) > 0).count() < 3) continue;
    const PoseLengths now = lengths.read(pose);
    for (int b = 0; b < kFlatBoneCount; ++b)
      told[static_cast<size_t>(b)].add(static_cast<double>(now.log_length[b]));
  }
  double drift = 0;
  for (const Running& bone : told) drift += 100 * bone.deviation() / kFlatBoneCount;
  return drift;
}

double mean_second_difference(const std::vector<FlatPose>& poses) {
  Running all;
  for (size_t t = 2; t < poses.size(); ++t) add_second_differences(poses[t], poses[t - 1], poses[t - 2], all);
  return all.mean();
}

FlatFigures flat_figures(const FlatSourceOptions& options, const LengthReader& lengths) {
  const KeypointReading reading = open_keypoints(options);
  const std::vector<CleanPose> clean = clean_track(reading, reading.performer);
  FlatFigures figures;
  figures.told = reading.told;
  figures.frames = static_cast<int64_t>(clean.size());
  TrackJitter jitter;
  Running seen, violation, as_it_is, cleaned;
  std::vector<FlatPose> usable;
  std::array<const FlatPose*, 3> raw{};
  for (size_t t = 0; t < clean.size(); ++t) {
    figures.mended += clean[t].sides_mended ? 1 : 0;
    raw = {raw[1], raw[2], clean[t].is_usable ? reading.performing().at(static_cast<int64_t>(t)) : nullptr};
    if (!raw[2]) {
      ++figures.flagged;
      jitter.restart();
      continue;
    }
    const FlatPose& pose = *raw[2];
    jitter.push(pose, static_cast<float>(1 / reading.fps));
    seen.add(100.0 * points_seen(pose) / kBodyPoints);
    violation.add(order_violation(clean[t].pose, pose));
    if (raw[0] && raw[1]) {
      add_second_differences(pose, *raw[1], *raw[0], as_it_is);
      add_second_differences(clean[t].pose, clean[t - 1].pose, clean[t - 2].pose, cleaned);
    }
    usable.push_back(clean[t].pose);
  }
  add_known(figures.metrics, "seen", seen.mean());
  if (jitter.pixels() >= 0) add_known(figures.metrics, "jitter_px", static_cast<double>(jitter.pixels()));
  add_known(figures.metrics, "jitter_after", cleaned.mean() / as_it_is.mean());
  add_known(figures.metrics, "violation", violation.mean());
  add_known(figures.metrics, "drift", length_drift(usable, lengths));
  return figures;
}

}  // namespace understudy::app
