// Metrics: curves over time tied to the timeline, the table of the whole, latency.
// Marks: metrics.curves, metrics.table, metrics.latency (sections); metrics.plot.KEY,
// metrics.in_timeline.KEY, metrics.figures.ROW(.text), metrics.needs_truth, metrics.stages.ROW,
// metrics.stage, metrics.histogram, metrics.csv.
#pragma once

#include <cstdint>
#include <vector>

namespace understudy::ui {

struct MetricsState {
  int stage = 4;  ///< of the histogram: Latency::kStages
  // The durations of that stage, as many as show their distribution; made again when there are more frames.
  int64_t frames = -1;
  int of_stage = -1, of_take = -1;
  std::vector<float> durations;
};

}  // namespace understudy::ui
