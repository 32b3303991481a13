// A plot of movements: small ghosted figures where there is room, points everywhere.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "render/image.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::render {

/// A movement on the map.
struct MapPoint {
  Eigen::Vector2f at;  ///< in the axes' own units
  Vec3 color;          ///< sRGB, 0..1
};

struct MapPlotOptions {
  std::string title, subtitle, x_label, y_label;
  /// What the colours mean: names with their colours, or a scale.
  std::vector<std::pair<std::string, Vec3>> legend;
  struct Scale {
    Vec3 (*color)(float share) = nullptr;  ///< null: there is none
    double low = 0, high = 1;
    std::string label;  ///< "speed, m/s"
  } scale;
  std::vector<int> marked;  ///< points that are ringed and numbered from 1, with their figures
  /// Moments of a point's movement in metres, facing +z, the floor at 0; empty: there are no figures.
  std::function<std::vector<Joints>(int point)> figure;
  int width = 1600, height = 1100;  ///< pixels
};

/// The same points give the same picture. Throws Error where there is no point, or one is not finite.
Image map_plot(const std::vector<MapPoint>& points, const MapPlotOptions& options);

}  // namespace understudy::render
