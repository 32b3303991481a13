// Figures before and after a change, as dots over the band in which others of a kind lie.
#pragma once

#include <string>
#include <vector>

#include "render/image.hpp"

namespace understudy::render {

/// What is not finite is left out.
struct BandRow {
  std::string name, unit;
  int digits = 2;                        ///< after the point
  double before = 0, after = 0;          ///< not negative
  double low = 0, middle = 0, high = 0;  ///< of the band
};

struct BandPlotOptions {
  std::string title;
  std::string before = "before", after = "after", band = "band";  ///< for the legend
  int width = 900;                                                ///< pixels
};

/// A row a figure, each from 0 to a little above its greatest value. Throws Error without rows.
Image band_plot(const std::vector<BandRow>& rows, const BandPlotOptions& options);

}  // namespace understudy::render
