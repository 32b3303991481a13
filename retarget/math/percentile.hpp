// Percentiles of a handful of values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace understudy {

/// NumPy's percentile: linear between the sorted values. At least one value; percent 0..100.
inline double percentile(std::vector<double> values, double percent) {
  std::sort(values.begin(), values.end());
  const double at = percent / 100 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace understudy
