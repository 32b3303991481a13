#include "app/session/frame_figures.hpp"

#include <algorithm>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/metrics/metric_table.hpp"

namespace understudy::app {
namespace {

/// The first `count`; none of a list that is shorter.
template <class Item>
std::vector<Item> first_of(const std::vector<Item>& all, size_t count) {
  if (all.size() < count) return {};
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

MetricSequence seen_in(const FigureInput& input, size_t count) {
  MetricSequence seen;
  seen.joints = first_of(input.joints, count);
  size_t without_legs = 0;
  for (size_t t = 0; t < count; ++t) without_legs += legs_missing(input.performed[t].limbs) ? 1 : 0;
  seen.has_legs = 2 * without_legs < std::max<size_t>(count, 1);
  for (size_t t = 0; t < count; ++t) seen.rotations.push_back(input.shown.poses[t].local);
  for (size_t t = 0; t < count && input.source.size() >= count; ++t) {
    seen.source_joints.push_back(input.performed[t].source);
    seen.confidence.push_back(input.performed[t].flagged ? 0 : input.source[t].confidence);
  }
  return seen;
}

}  // namespace

Series blank_series(const std::string& key, size_t count) {
  const Metric* const metric = find_metric(key);
  US_CHECK(metric, "there is no metric ", key);
  return {metric->key, metric->label, metric->unit,
          std::vector<float>(count, std::numeric_limits<float>::quiet_NaN())};
}

std::vector<Series> joint_figures(const FigureInput& input) {
  const size_t shown = std::min(input.shown.poses.size(), input.joints.size()),
               count = std::min(shown, input.performed.size());
  MetricSequence seen = seen_in(input, count);
  seen.has_style = input.has_style;
  MetricSequence truth;
  if (input.truth)
    truth = {first_of(input.truth->joints, count),
             first_of(input.truth->rotations, count),
             first_of(input.truth->source_joints, count),
             {},
             {}};
  std::vector<Series> all;
  for (const Metric& metric : metric_table()) {
    if (!metric.per_frame || is_of_surfaces(metric) || !is_known(metric, seen, truth)) continue;
    all.push_back(blank_series(metric.key, shown));
    auto figures = per_frame_figures(metric, seen, truth, count, input.shown.fps);
    const bool is_speed = (metric.needs & kNeedsStyle) != 0;  // each that a style has of single frames
    for (size_t t = 0; is_speed && input.times != nullptr && t < figures.size(); ++t)
      figures[t] /= static_cast<float>(length_at(*input.times, input.shown.fps, static_cast<double>(t)));
    std::copy(figures.begin(), figures.end(), all.back().values.begin());
  }
  return all;
}

}  // namespace understudy::app
