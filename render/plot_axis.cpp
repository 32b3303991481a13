#include "render/plot_axis.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"

namespace understudy::render {

PlotAxis::PlotAxis(double least, double greatest) {
  const double span = std::max(greatest - least, 1e-9 * std::max(1.0, std::abs(greatest)));
  const double ten = std::pow(10, std::floor(std::log10(span / 5)));
  for (const double round : {1.0, 2.0, 5.0, 10.0})
    if (span / (round * ten) <= 7) {
      step = round * ten;
      break;
    }
  low = std::floor(least / step + 1e-9) * step;
  high = std::ceil(greatest / step - 1e-9) * step;
  if (high <= low) high = low + step;
}

std::string axis_number(double value) {
  return printed("%.6g", std::abs(value) < 1e-12 ? 0 : value);
}

}  // namespace understudy::render
