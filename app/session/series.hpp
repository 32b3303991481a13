// Figures over time: a value a frame, for plots, the table and CSV.
#pragma once

#include <string>
#include <vector>

namespace understudy::app {

/// One figure, NaN where it says nothing.
struct Series {
  std::string key;    ///< as in design's reports: "pa_mpjpe_m"
  std::string label;  ///< for people: "PA-MPJPE"
  std::string unit;   ///< "m", "mm", "deg", "m/s", ""
  bool lower_is_better = true;
  std::vector<float> values;
};

/// Finds a series by key; null when it is not there.
const Series* find(const std::vector<Series>& series, const std::string& key);

/// A frame a row: frame, seconds, then each series. Written beside and renamed. Throws Error naming the path.
void write_csv(const std::string& path, const std::vector<Series>& series, double fps);

}  // namespace understudy::app
