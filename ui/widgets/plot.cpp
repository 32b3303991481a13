#include "ui/widgets/plot.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

constexpr int kBins = 32;                // of a histogram
constexpr float kHistogramHeight = 110;  // at scale 1

/// Draws what the path holds and empties it; a point alone becomes a dot.
void finish_stroke(ImDrawList& list, ImU32 color, float thickness) {
  if (list._Path.Size == 1) {
    list.AddCircleFilled(list._Path[0], thickness, color);
    list.PathClear();
  } else {
    list.PathStroke(color, 0, thickness);
  }
}

/// Everything one plot's drawing needs.
struct Plot {
  Ui& ui;
  const std::string& name;
  const std::vector<PlotLine>& series;
  const PlotOptions& options;
  ImDrawList& list;
  Rect all;
  FrameAxis axis;
  Range range;

  ImU32 color_of(size_t k) const {
    const auto& colors = ui.theme().series;
    const int wanted = series[k].color >= 0 ? series[k].color : static_cast<int>(k);
    return color(colors[wanted % colors.size()]);
  }
};

float word_width(const std::string& words) {
  return ImGui::CalcTextSize(words.c_str()).x;
}

double tick_step(const std::vector<double>& ticks) {
  return ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
}

/// The range of all values, with a margin.
Range value_range(const std::vector<PlotLine>& series) {
  Range range;
  for (const PlotLine& one : series)
    for (int i = 0; i < one.values.size; ++i) range.include(one.values.data[i]);
  if (range.empty()) return {0, 1};
  const float air =
      range.high > range.low ? 0.06f * (range.high - range.low) : std::max(0.5f, std::abs(range.low) * 0.1f);
  const bool from_zero = range.low >= 0 && range.low < 0.4f * range.high;
  return {from_zero ? 0 : range.low - air, range.high + air};
}

void draw_legend(Plot& p, const ImVec2& at, float width) {
  float x = at.x, wanted = 0;
  const float line = ImGui::GetTextLineHeight(), dash = p.ui.px(12), around = dash + p.ui.px(19),
              right = at.x + width - word_width(p.options.unit) - p.ui.px(10);
  for (const PlotLine& one : p.series) wanted += word_width(one.label) + around;
  const float share = (right - at.x) / static_cast<float>(std::max<size_t>(1, p.series.size())) - around;
  const bool all_fit = wanted <= right - at.x;
  for (size_t k = 0; k < p.series.size(); ++k) {
    const float room = all_fit ? right - x : std::max(share, p.ui.px(24));
    if (x + dash + p.ui.px(24) > right) break;
    const std::string label = cut_name(p.series[k].label, room);
    p.list.AddLine({x, at.y + line / 2}, {x + dash, at.y + line / 2}, p.color_of(k), p.ui.px(2));
    const ImVec2 from(x + dash + p.ui.px(5), at.y);
    p.list.AddText(from, color(p.ui.theme().text_dim), label.c_str());
    p.ui.mark(p.name + ".label." + std::to_string(k), {from, {from.x + word_width(label), from.y + line}});
    x += around + word_width(label);
  }
  p.list.AddText({at.x + width - word_width(p.options.unit), at.y}, color(p.ui.theme().text_dim),
                 p.options.unit.c_str());
}

void draw_value_axis(Plot& p, const std::vector<double>& ticks) {
  const Rect& area = p.axis.area;
  const float line = ImGui::GetTextLineHeight();
  for (const double tick : ticks) {
    const float y = std::round(
        area.max.y - static_cast<float>((tick - p.range.low) / (p.range.high - p.range.low)) * area.height());
    p.list.AddLine({area.min.x, y}, {area.max.x, y}, color(p.ui.theme().line, tick == 0 ? 1 : 0.6f));
    const std::string label = tick_label(tick, tick_step(ticks));
    p.list.AddText({area.min.x - word_width(label) - p.ui.px(6), y - line / 2}, color(p.ui.theme().text_dim),
                   label.c_str());
  }
}

void draw_frame_axis(Plot& p) {
  const Rect& area = p.axis.area;
  const auto ticks =
      round_ticks(p.axis.first, p.axis.last, std::max(1, static_cast<int>(area.width() / p.ui.px(64))));
  for (const double tick : ticks) {
    if (tick != std::floor(tick)) continue;
    const float x = std::round(p.axis.x(tick));
    const std::string label = tick_label(tick, std::max(1.0, tick_step(ticks)));
    p.list.AddLine({x, area.max.y}, {x, area.max.y + p.ui.px(3)}, color(p.ui.theme().line));
    const float left = std::clamp(x - word_width(label) / 2, p.all.min.x,
                                  std::max(p.all.min.x, p.all.max.x - word_width(label)));
    p.list.AddText({left, area.max.y + p.ui.px(4)}, color(p.ui.theme().text_dim), label.c_str());
  }
  for (const int bad : p.options.bad_frames) {
    if (bad < p.axis.first || bad > p.axis.last) continue;
    const float x = p.axis.x(bad), half = std::max(1.f, 0.5f * (p.axis.x(1) - p.axis.x(0)));
    p.list.AddRectFilled({x - half, area.max.y - p.ui.px(4)}, {x + half, area.max.y},
                         color(p.ui.theme().danger));
  }
}

void draw_hover(Plot& p, int frame) {
  const Rect& area = p.axis.area;
  const float x = std::round(p.axis.x(frame));
  p.list.AddLine({x, area.min.y}, {x, area.max.y}, color(p.ui.theme().text_dim, 0.7f));
  for (size_t k = 0; k < p.series.size(); ++k) {
    const float value = p.series[k].values.at(frame);
    const float y = area.max.y - (value - p.range.low) / (p.range.high - p.range.low) * area.height();
    if (std::isfinite(value)) p.list.AddCircleFilled({x, y}, p.ui.px(3), p.color_of(k));
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {p.ui.px(9), p.ui.px(6)});
  ImGui::BeginTooltip();
  ImGui::TextColored(p.ui.theme().text_dim, "Frame %d", frame);
  for (size_t k = 0; k < p.series.size(); ++k)
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(p.color_of(k)), "%s  %s %s", p.series[k].label.c_str(),
                       short_number(p.series[k].values.at(frame)).c_str(), p.options.unit.c_str());
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

int frame_count(const std::vector<PlotLine>& series) {
  int count = 0;
  for (const PlotLine& one : series) count = std::max(count, one.values.size);
  return count;
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
  const bool thousands = std::abs(value) >= 10000 && std::fmod(step, 100) == 0;
  if (thousands) return printed(std::fmod(step, 1000) == 0 ? "%.0fk" : "%.1fk", value / 1000);
  const int decimals =
      step >= 1 || !(step > 0) ? 0 : std::min(9, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return printed("%.*f", decimals, value);
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
      if (column.empty()) finish_stroke(list, color, thickness);
      if (!column.empty()) list.PathLineTo({x, y(column.low)});
      if (column.high > column.low) list.PathLineTo({x, y(column.high)});
    }
  }
  finish_stroke(list, color, thickness);
}

std::optional<int> plot(Ui& ui, const std::string& name, const std::vector<PlotLine>& series,
                        const PlotOptions& options) {
  const FontScope small(ui.fonts().small);
  const ImVec2 at = ImGui::GetCursorScreenPos(),
               size(std::max(ImGui::GetContentRegionAvail().x, ui.px(60)), ui.px(options.height));
  Plot p{ui, name, series, options, *ImGui::GetWindowDrawList(), {at, {at.x + size.x, at.y + size.y}},
         {}, {}};
  const int count = frame_count(series);
  p.axis.last = std::max(1, count - 1);
  p.range = value_range(series);
  const float line = ImGui::GetTextLineHeight();
  const auto ticks = round_ticks(p.range.low, p.range.high,
                                 std::max(1, static_cast<int>((size.y - 3 * line) / (1.6f * line))));
  float labels = 0;
  for (const double tick : ticks) labels = std::max(labels, word_width(tick_label(tick, tick_step(ticks))));
  p.axis.area = {{at.x + labels + ui.px(8), at.y + line + ui.px(8)},
                 {at.x + size.x - ui.px(6), at.y + size.y - line - ui.px(5)}};

  const bool pressed = ImGui::InvisibleButton(name.c_str(), size);
  ui.mark(name, p.axis.area);
  draw_legend(p, at, size.x);
  draw_value_axis(p, ticks);
  draw_frame_axis(p);
  p.list.PushClipRect(p.axis.area.min, p.axis.area.max, true);
  for (size_t k = series.size(); k-- > 0;)  // the first, the selected take's, over the others
    draw_curve(p.list, p.axis, series[k].values, p.range, p.color_of(k), ui.px(1.5f));
  const float now = std::round(p.axis.x(options.current));
  if (options.current >= 0)
    p.list.AddLine({now, p.axis.area.min.y}, {now, p.axis.area.max.y}, color(ui.theme().accent), ui.px(1.5f));
  p.list.PopClipRect();

  const int frame = std::clamp(static_cast<int>(std::lround(p.axis.frame(ImGui::GetIO().MousePos.x))), 0,
                               std::max(0, count - 1));
  const bool held = ImGui::IsItemActive();
  if (count > 0 && (held || ImGui::IsItemHovered())) draw_hover(p, frame);
  return count > 0 && (held || pressed) ? std::optional<int>(frame) : std::nullopt;
}

void histogram(Ui& ui, const std::string& name, const Values& values, const HistogramOptions& options) {
  const FontScope small(ui.fonts().small);
  const ImVec2 at = ImGui::GetCursorScreenPos(),
               size(std::max(ImGui::GetContentRegionAvail().x, ui.px(60)), ui.px(kHistogramHeight));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::Dummy(size);
  ui.mark(name);
  Range range;
  for (int i = 0; i < values.size; ++i) range.include(values.data[i]);
  if (range.empty()) return list.AddText(at, color(ui.theme().text_dim), "No values yet.");
  if (range.high == range.low) range.high += 1;
  std::vector<int> counts(kBins);
  for (int i = 0; i < values.size; ++i)
    if (std::isfinite(values.data[i])) {
      const size_t bin =
          (values.data[i] - range.low) / (range.high - range.low) * static_cast<float>(counts.size());
      ++counts[std::min(bin, counts.size() - 1)];
    }
  const float line = ImGui::GetTextLineHeight(),
              most = static_cast<float>(*std::max_element(counts.begin(), counts.end()));
  const Rect area{{at.x, at.y + line + ui.px(6)}, {at.x + size.x, at.y + size.y - line - ui.px(4)}};
  const float each = area.width() / static_cast<float>(counts.size());
  for (size_t b = 0; b < counts.size(); ++b) {
    const float left = area.min.x + each * static_cast<float>(b),
                high = static_cast<float>(counts[b]) / most * area.height();
    if (counts[b] > 0)
      list.AddRectFilled({left, area.max.y - std::max(high, 1.f)},
                         {left + std::max(1.f, each - 1), area.max.y}, color(ui.theme().series[0], 0.8f));
  }
  list.AddLine({area.min.x, area.max.y}, area.max, color(ui.theme().line));
  const auto write = [&](float x, float y, const std::string& words, const ImVec4& with) {
    const float left = std::clamp(x - word_width(words) / 2, area.min.x,
                                  std::max(area.min.x, area.max.x - word_width(words)));
    list.AddText({left, y}, color(with), words.c_str());
    return left + word_width(words);
  };
  const auto ticks =
      round_ticks(range.low, range.high, std::max(2, static_cast<int>(area.width() / ui.px(64))));
  const auto x_of = [&](double v) {
    return area.min.x + static_cast<float>((v - range.low) / (range.high - range.low)) * area.width();
  };
  for (const double tick : ticks)
    write(x_of(tick), area.max.y + ui.px(3), tick_label(tick, tick_step(ticks)), ui.theme().text_dim);
  float written = area.min.x;
  for (const auto& [label, value] : options.marks) {
    const float x = std::round(x_of(value));
    list.AddLine({x, area.min.y}, {x, area.max.y}, color(ui.theme().series[1]), ui.px(1.5f));
    const std::string words =
        label + " " + short_number(value) + (options.unit.empty() ? "" : " " + options.unit);
    written = write(std::max(x, written + word_width(words) / 2 + (written > area.min.x ? ui.px(10) : 0)),
                    at.y, words, ui.theme().series[1]);
  }
}

}  // namespace understudy::ui
