// Every widget on one page, with made-up content: to look at, and to find words that do not fit.
#pragma once

#include <string>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// What the page's controls change.
struct GalleryState {
  bool skeleton = true, weights = false;
  int view = 1, method = 0, theme = 0;
  float smoothing = 0.35f, radius = 12;
  std::string name = "walk_female_03";
  int frame = 412;
};

/// A page that fills the display.
void draw_gallery(Ui& ui, GalleryState& state);

}  // namespace understudy::ui
