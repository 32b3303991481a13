// Plots over frames, histograms and colour legends.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ui/gui/ui.hpp"
#include "ui/widgets/axis.hpp"

namespace understudy::ui {

struct PlotLine {
  std::string label;
  Values values;
  int color = -1;  ///< of Theme::series; -1: by its place
};

struct PlotOptions {
  std::string unit;
  float height = 150;           ///< at scale 1, all of it
  int current = -1;             ///< the frame that is shown elsewhere
  std::vector<int> bad_frames;  ///< marked at the bottom
  double first = 0, last = -1;  ///< frames shown; last < first: all
  Range range;                  ///< of values shown; empty: as they want
};

struct PlotAnswer {
  int hovered = -1;         ///< the frame under the pointer
  std::optional<int> seek;  ///< clicked or dragged to this frame
};

/// Curves over frames with axes, a legend, and the values under the pointer. Over the width that is left.
PlotAnswer plot(Ui& ui, const std::string& name, const std::vector<PlotLine>& series,
                const PlotOptions& options = {});

struct HistogramOptions {
  std::string unit;
  float height = 110;  ///< at scale 1
  int bins = 32;
  std::vector<std::pair<std::string, float>> marks;  ///< "p50", value
};
/// How often values occur; NaN ones are left out.
void histogram(Ui& ui, const std::string& name, const Values& values, const HistogramOptions& options = {});

}  // namespace understudy::ui
