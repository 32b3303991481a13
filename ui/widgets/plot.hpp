// Plots over frames and histograms; and what the timeline shares with them: arrays of values, ticks, curves.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// One value a frame, read during the call only; NaN: no value there.
struct Values {
  const float* data = nullptr;
  int size = 0;
  Values() = default;
  Values(const float* values, int count) : data(values), size(count) {}
  Values(const std::vector<float>& values) : data(values.data()), size(values.size()) {}
  float at(int i) const { return i >= 0 && i < size ? data[i] : std::numeric_limits<float>::quiet_NaN(); }
};

/// From low to high; empty when low > high.
struct Range {
  float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
  bool empty() const { return !(low <= high); }
  void include(float value) {
    if (!std::isfinite(value)) return;
    low = std::fmin(low, value), high = std::fmax(high, value);
  }
};

/// Least and greatest finite value of frames first..last for each of `columns` equal parts; empty where there
/// is none. At most one look at each value.
std::vector<Range> reduce(const Values& values, double first, double last, int columns);

/// Round numbers (1, 2, 5 times a power of ten) in low..high, at most `most` of them.
std::vector<double> round_ticks(double low, double high, int most);
/// A tick's label, as short as the step allows: "0.25", "40", "1.5k".
std::string tick_label(double value, double step);

/// Maps frames to pixels: `first` to the left edge of `area`, `last` to the right.
struct FrameAxis {
  Rect area;
  double first = 0, last = 1;
  float x(double frame) const {
    const double span = std::fmax(last - first, 1e-9);
    return area.min.x + static_cast<float>((frame - first) / span) * area.width();
  }
  double frame(float x) const {
    return first + static_cast<double>((x - area.min.x) / std::fmax(area.width(), 1.f)) * (last - first);
  }
};

/// Draws a curve, with gaps where there is no value. Cost grows with pixels, not frames.
void draw_curve(ImDrawList& list, const FrameAxis& axis, const Values& values, const Range& range,
                ImU32 color, float thickness);

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
};

/// Curves over all frames with axes, a legend, and the values under the pointer. Over the width that is left.
/// The frame that was clicked or dragged to.
std::optional<int> plot(Ui& ui, const std::string& name, const std::vector<PlotLine>& series,
                        const PlotOptions& options = {});

struct HistogramOptions {
  std::string unit;
  std::vector<std::pair<std::string, float>> marks;  ///< "p50", value
};
/// How often values occur; NaN ones are left out.
void histogram(Ui& ui, const std::string& name, const Values& values, const HistogramOptions& options = {});

}  // namespace understudy::ui
