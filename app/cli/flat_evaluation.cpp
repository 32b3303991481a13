#include "app/cli/flat_evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/run/flat_figures.hpp"
#include "app/run/flat_performance.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/pose2d/limb_transfer.hpp"

namespace understudy::app {
namespace {

using Poses = std::vector<FlatPose>;

Poses poses_of(const KeypointReading& reading) {
  Poses poses(reading.frames.size());
  for (const TrackedPose& tracked : reading.performing().poses) {
    FlatPose pose = tracked.pose;
    add_middles(pose);
    poses[static_cast<size_t>(tracked.frame)] = std::move(pose);
  }
  return poses;
}

/// Mean over the frames that say something.
template <typename F>
double mean_over(size_t frames, F f) {
  double sum = 0, count = 0;
  for (size_t t = 0; t < frames; ++t)
    if (const double value = f(t); std::isfinite(value)) sum += value, ++count;
  return sum / count;
}

/// Only the points that the source shows.
FlatPose shown_in(FlatPose pose, const FlatPose& source) {
  for (int point = 0; point < kBodyPoints; ++point)
    if (!source.has(point)) pose.forget(point);
  return pose;
}

double similarity(const Poses& made, const Poses& truth, const Poses& source) {
  return mean_over(truth.size(),
                   [&](size_t t) { return keypoint_similarity(shown_in(made[t], source[t]), truth[t]); });
}

/// Each frame by itself, with these lengths.
Poses by_lengths(const Poses& source, const BoneLengths& from, const BoneLengths& to, bool touches) {
  LimbTransfer limbs(touches);
  Proportions a, b;
  a.length = from, b.length = to;
  Poses made;
  for (const FlatPose& pose : source) made.push_back(limbs.transfer(pose, a, b));
  return made;
}

BoneLengths sides_alike(const BoneLengths& length) {
  BoneLengths alike = length;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const float other = length[kFlatBoneMirror[static_cast<size_t>(b)]];
    alike[b] = length[b] > 0 && other > 0 ? (length[b] + other) / 2 : std::max(length[b], other);
  }
  return alike;
}

/// Ratios from a third to three; 1 where one of both was not seen.
BoneLengths target_by_ratio(const BoneLengths& source, const BoneLengths& target) {
  BoneLengths result = source;
  for (int b = 0; b < kFlatBoneCount; ++b)
    if (source[b] > 0 && target[b] > 0)
      result[b] = source[b] * std::clamp(target[b] / source[b], 1 / 3.0f, 3.0f);
  return result;
}

BoneLengths longest_of(const Poses& poses) {
  BoneLengths longest = BoneLengths::Zero();
  for (const FlatPose& pose : poses) longest = longest.max(seen_lengths(pose));
  return longest;
}

double kept_percent(const Poses& made, double stature, const Poses& source, double source_stature) {
  Touches all;
  for (size_t t = 0; t < made.size(); ++t) {
    const Touches now = touches_kept(made[t], stature, source[t], source_stature);
    all.near += now.near, all.kept += now.kept;
  }
  return all.near > 0 ? 100.0 * all.kept / all.near : std::nan("");
}

void add_figure(Metrics& figures, const char* key, double value) {
  if (std::isfinite(value)) figures.emplace_back(key, value);
}

/// Each bone's ratio in the first frames.
Poses by_one_frame(const Poses& source, const Poses& known) {
  const BoneLengths first = sides_alike(seen_lengths(source[0])), from = (first > 0).select(first, 1.0f);
  return by_lengths(source, from, target_by_ratio(from, sides_alike(seen_lengths(known[0]))), false);
}

/// What others do.
void add_baselines(const Case& c, const Poses& source, const Poses& known, const Poses& truth, Metrics& to) {
  const auto add = [&](const char* key, const Poses& made) {
    add_figure(to, key, similarity(made, truth, source));
  };
  add("oks_copy", source);
  const BoneLengths first = sides_alike(seen_lengths(source[0])),
                    picture = sides_alike(seen_lengths(known[0]));
  const float scale = (first * picture).sum() / std::max(first.square().sum(), 1e-6f);
  add("oks_scale", by_lengths(source, BoneLengths::Ones(), BoneLengths::Constant(scale), false));
  const auto by_ratio = [&](const BoneLengths& a, const BoneLengths& b) {
    const BoneLengths from = (a > 0).select(a, 1.0f);
    return by_lengths(source, from, target_by_ratio(from, b), false);
  };
  add("oks_one", by_one_frame(source, known));
  add("oks_longest", by_ratio(sides_alike(longest_of(source)), sides_alike(longest_of(known))));
  add("oks_true", by_lengths(source, c.flat->source_lengths, c.flat->target_lengths, false));
}

}  // namespace

FlatEvaluation::FlatEvaluation(const EvalOptions& options)
    : engine_(flat_engine(options.how)), pictures_(options.pictures), tools_(flat_tools(options.how)) {}

void FlatEvaluation::keep_moment(const Case& c, const FlatMoment& moment, size_t frame) {
  FlatOptions options;
  options.source.path = c.source, options.target.path = c.target;
  FlatMoment& kept = moments_.emplace_back(moment);
  for (const MethodChoice& engine : flat_engines()) {
    options.engine = engine.name;
    kept.engines.emplace_back(engine.name, poses_of(perform_flat(options, tools_).result)[frame]);
  }
}

void FlatEvaluation::evaluate(const Case& c, CaseResult& result) {
  FlatOptions options;
  options.source.path = c.source, options.target.path = c.target;
  options.engine = engine_, options.touches = false;
  const auto began = std::chrono::steady_clock::now();
  const FlatPerformance performed = perform_flat(options, tools_);
  FrameTimes times;
  times.transfer = times.total = ms_since(began) / static_cast<double>(performed.result.frames.size());
  const Poses source = poses_of(performed.source), made = poses_of(performed.result),
              truth = poses_of(read_keypoints(c.truth)), known = poses_of(read_keypoints(c.target));
  US_CHECK(truth.size() == made.size(), c.truth, ": has ", truth.size(), " frames, the source ", made.size());
  options.touches = true;
  const Poses touching = poses_of(perform_flat(options, tools_).result);
  for (size_t t = 0; t < made.size(); ++t) result.latency.add(times);
  result.frames = ssize(made), result.flagged = performed.flagged;

  Metrics& figures = result.metrics;
  const auto against_source = [&](double (*f)(const FlatPose&, const FlatPose&), const Poses& of) {
    return mean_over(of.size(), [&](size_t t) { return f(of[t], source[t]); });
  };
  add_figure(figures, "oks", similarity(made, truth, source));
  add_figure(figures, "nmpjpe2d", mean_over(made.size(), [&](size_t t) {
               return normalised_point_error(shown_in(made[t], source[t]), truth[t]);
             }));
  add_figure(figures, "violation", against_source(order_violation, made));
  add_figure(figures, "angles_rad", against_source(bone_angle_error, made));
  add_figure(figures, "jitter", mean_second_difference(made) / mean_second_difference(truth));
  add_figure(figures, "oks_touches", similarity(touching, truth, source));
  add_figure(figures, "violation_touches", against_source(order_violation, touching));
  add_figure(figures, "violation_truth", against_source(order_violation, truth));
  const double from = static_cast<double>(stature_of(c.flat->source_lengths)),
               to = static_cast<double>(stature_of(c.flat->target_lengths));
  add_figure(figures, "near_kept", kept_percent(touching, to, source, from));
  add_figure(figures, "near_let_go", kept_percent(made, to, source, from));
  add_figure(figures, "near_truth", kept_percent(truth, to, source, from));
  add_figure(figures, "bone_ratio",
             bone_ratio_error(performed.target_lengths.length, c.flat->target_lengths));
  add_baselines(c, source, known, truth, figures);
  constexpr size_t kMostMoments = 6;
  if (!pictures_ || known.size() != 1 || moments_.size() >= kMostMoments) return;
  const size_t middle = source.size() / 2;
  keep_moment(c, {c.name, source[middle], known[0], truth[middle], by_one_frame(source, known)[middle]},
              middle);
}

}  // namespace understudy::app
