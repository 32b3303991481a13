// Figures over time: one value per frame, for plots, the table and CSV.
#pragma once

#include <string>
#include <vector>

namespace understudy::app {

/// One figure; NaN where it has no value.
struct Series {
  std::string key;    ///< as in design's reports: "pa_mpjpe_m"
  std::string label;  ///< for people: "PA-MPJPE"
  std::string unit;   ///< "m", "mm", "deg", "m/s", ""
  std::vector<float> values;
};

/// The series with this key; null when there is none.
const Series* find(const std::vector<Series>& series, const std::string& key);

/// One row per frame: frame, seconds of the source, where it has a tempo seconds in the take, then each
/// series. take_seconds: of each frame; empty: there are none. Throws Error naming the path.
void write_csv(const std::string& path, const std::vector<Series>& series, double fps,
               const std::vector<double>& take_seconds = {});

}  // namespace understudy::app
