// Movements side by side, each as ghosts of one body coloured by the time at which it is there (paper 2,
// figure 6).
#pragma once

#include <string>
#include <vector>

#include "render/renderer.hpp"

namespace understudy::render {

/// One movement.
struct GhostSeries {
  std::string caption;
  std::vector<Mesh> ghosts;     ///< where they are in the world, metres, y up
  std::vector<double> seconds;  ///< of each, from the movement's beginning
};

struct GhostSheetOptions {
  std::string title;
  int width = 1800;   ///< pixels; the height follows
  int columns = 4;    ///< cells in a row; more continue below
  float heading = 0;  ///< radians about +y that they face at first, 0 is +z: they go from left to right
};

/// A cell for each series, all at one scale; one scale of time for all, drawn below. Throws Error without
/// series, where one has no ghost, and where ghosts and times are not equally many.
Image ghost_sheet(Renderer& renderer, const std::vector<GhostSeries>& series,
                  const GhostSheetOptions& options = {});
/// The same with an offscreen context of its own; no context is current on this thread afterwards.
Image ghost_sheet(const std::vector<GhostSeries>& series, const GhostSheetOptions& options = {});

}  // namespace understudy::render
