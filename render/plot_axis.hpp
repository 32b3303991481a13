// The axes of plots.
#pragma once

#include <string>

namespace understudy::render {

/// Round numbers from below the least value to above the greatest, not above ten steps.
struct PlotAxis {
  double low = 0, high = 1, step = 0.2;

  PlotAxis(double least, double greatest);
  /// 0 at the low end, 1 at the high one.
  float share(double value) const { return static_cast<float>((value - low) / (high - low)); }
};

/// A number of such an axis, as short as it can be.
std::string axis_number(double value);

}  // namespace understudy::render
