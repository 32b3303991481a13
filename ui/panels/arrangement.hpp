// The layout of the window.
#pragma once

#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// The parts to place. Sizes at scale 1.
struct Parts {
  bool side = true, timeline = true, below = false;
  float side_width = 372, below_height = 150;
};

/// In pixels. Parts that are hidden or have no room are empty.
struct Arrangement {
  Rect top, views, below, side, timeline, status;
  Rect side_edge;       ///< where the side panel's width is dragged
  bool narrow = false;  ///< the side panel lies over the views
};

/// Whether a window of this width has the side panel over the views.
bool is_narrow(float width, float scale);

/// Fits any size: hides the least important parts first.
Arrangement arrange(const ImVec2& display, float scale, const Parts& parts);

}  // namespace understudy::ui
