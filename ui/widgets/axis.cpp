#include "ui/widgets/axis.hpp"

#include <algorithm>
#include <cstdio>

namespace understudy::ui {
namespace {

/// Draws what the path holds and empties it; a point alone becomes a dot.
void finish_stroke(ImDrawList& list, ImU32 color, float thickness) {
  if (list._Path.Size == 1) {
    list.AddCircleFilled(list._Path[0], thickness, color);
    list.PathClear();
  } else {
    list.PathStroke(color, 0, thickness);
  }
}

}  // namespace

std::vector<Range> reduce(const Values& values, double first, double last, int columns) {
  std::vector<Range> reduced(std::max(columns, 0));
  const double span = std::max(last - first, 1e-9);
  const int from = std::max(0, static_cast<int>(std::floor(first))),
            to = std::min(values.size - 1, static_cast<int>(std::ceil(last)));
  for (int i = from; i <= to; ++i) {
    const double at = (i - first) / span * columns;
    if (at < 0 || at > columns) continue;
    if (columns > 0) reduced[std::min(static_cast<int>(at), columns - 1)].include(values.data[i]);
  }
  return reduced;
}

std::vector<double> round_ticks(double low, double high, int most) {
  if (!(high > low) || most < 1) return {};
  const double rough = (high - low) / most, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double times : {5.0, 2.0, 1.0})
    if (times * power >= rough) step = times * power;
  std::vector<double> ticks;
  for (double at = std::ceil(low / step - 1e-9) * step; at <= high + 1e-9 * step; at += step)
    ticks.push_back(std::abs(at) < 1e-9 * step ? 0 : at);
  return ticks;
}

std::string tick_label(double value, double step) {
  char words[48];
  const bool thousands = std::abs(value) >= 10000 && std::fmod(step, 100) == 0;
  if (thousands) {
    std::snprintf(words, sizeof words, std::fmod(step, 1000) == 0 ? "%.0fk" : "%.1fk", value / 1000);
  } else {
    const int decimals =
        step >= 1 || !(step > 0) ? 0 : std::min(9, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    std::snprintf(words, sizeof words, "%.*f", decimals, value);
  }
  return words;
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::abs(value);
  char words[48];
  std::snprintf(words, sizeof words, "%.*f",
                size >= 100  ? 0
                : size >= 10 ? 1
                : size >= 1  ? 2
                : size == 0  ? 0
                             : 3,
                value);
  return words;
}

void draw_curve(ImDrawList& list, const FrameAxis& axis, const Values& values, const Range& range,
                ImU32 color, float thickness) {
  const double frames = axis.last - axis.first;
  const float height = axis.area.height(), span = std::max(range.high - range.low, 1e-12f);
  const auto y = [&](float value) { return axis.area.max.y - (value - range.low) / span * height; };
  const int columns = static_cast<int>(axis.area.width());
  if (frames <= columns) {
    const int from = std::max(0, static_cast<int>(std::floor(axis.first))),
              to = std::min(values.size - 1, static_cast<int>(std::ceil(axis.last)));
    for (int i = from; i <= to; ++i) {
      if (std::isfinite(values.data[i]))
        list.PathLineTo({axis.x(i), y(values.data[i])});
      else
        finish_stroke(list, color, thickness);
    }
  } else {
    const std::vector<Range> reduced = reduce(values, axis.first, axis.last, columns);
    for (int c = 0; c < columns; ++c) {
      const Range& column = reduced[c];
      const float x = axis.area.min.x + static_cast<float>(c) + 0.5f;
      if (column.empty()) {
        finish_stroke(list, color, thickness);
        continue;
      }
      list.PathLineTo({x, y(column.low)});
      if (column.high > column.low) list.PathLineTo({x, y(column.high)});
    }
  }
  finish_stroke(list, color, thickness);
}

}  // namespace understudy::ui
