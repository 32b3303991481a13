// Line plots as pictures.
#pragma once

#include <string>
#include <vector>

#include "render/image.hpp"

namespace understudy::render {

struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< equally many; points that are not finite are left out
};

struct PlotOptions {
  std::string title, x_label, y_label;
  int width = 900, height = 540;  ///< pixels
};

/// The curves with marks at their points, axes from a round number below the least value (0 for y) to one
/// above the greatest, and a legend where there are several. Throws Error when no curve has a finite point.
Image plot(const std::vector<Curve>& curves, const PlotOptions& options);

}  // namespace understudy::render
