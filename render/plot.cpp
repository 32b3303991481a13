#include "render/plot.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot_axis.hpp"
#include "render/strokes.hpp"
#include "render/text.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

using Eigen::Vector2f;

constexpr int kLeft = 78, kRight = 24, kTop = 66, kBottom = 62;  // pixels about the axes
const Vec3 kAxisInk(0.13f, 0.15f, 0.18f), kFaint(0.87f, 0.88f, 0.90f), kAxisPaper(1, 1, 1);
const Vec3 kColors[] = {{0.12f, 0.42f, 0.70f}, {0.85f, 0.37f, 0.12f}, {0.17f, 0.58f, 0.31f},
                        {0.55f, 0.30f, 0.66f}, {0.62f, 0.54f, 0.10f}, {0.35f, 0.38f, 0.42f}};

void draw_line(Image& image, const Vector2f& a, const Vector2f& b, float width, const Vec3& color) {
  paint(image, {{a, b, width, width}}, color);
}

/// Where values lie in the picture.
struct Frame {
  PlotAxis x, y;
  int width, height;
  Vector2f at(double px, double py) const {
    return {kLeft + x.share(px) * static_cast<float>(width - kLeft - kRight),
            static_cast<float>(height - kBottom) - y.share(py) * static_cast<float>(height - kTop - kBottom)};
  }
};

Frame frame_of(const std::vector<Curve>& curves, const PlotOptions& options) {
  double left = INFINITY, right = -INFINITY, low = 0, high = -INFINITY;
  for (const Curve& curve : curves) {
    US_CHECK(curve.x.size() == curve.y.size(), curve.name, ": ", curve.x.size(), " places for ",
             curve.y.size(), " values");
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
      left = std::min(left, curve.x[i]);
      right = std::max(right, curve.x[i]);
      low = std::min(low, curve.y[i]);
      high = std::max(high, curve.y[i]);
    }
  }
  US_CHECK(left <= right, options.title, ": there is nothing to plot");
  return {PlotAxis(left, right), PlotAxis(low, high), options.width, options.height};
}

void draw_axes(Image& image, const Font& font, const Frame& frame, const PlotOptions& options) {
  for (double v = frame.y.low; v <= frame.y.high + 0.5 * frame.y.step; v += frame.y.step) {
    const Vector2f from = frame.at(frame.x.low, v);
    draw_line(image, from, frame.at(frame.x.high, v), 1, kFaint);
    const std::string text = axis_number(v);
    font.draw(image, text, {from.x() - 9 - font.width(text, 15), from.y() + 5}, 15, kAxisInk);
  }
  for (double v = frame.x.low; v <= frame.x.high + 0.5 * frame.x.step; v += frame.x.step) {
    const Vector2f from = frame.at(v, frame.y.low);
    draw_line(image, from, frame.at(v, frame.y.high), 1, kFaint);
    const std::string text = axis_number(v);
    font.draw(image, text, {from.x() - 0.5f * font.width(text, 15), from.y() + 21}, 15, kAxisInk);
  }
  const float right = static_cast<float>(frame.width - kRight),
              bottom = static_cast<float>(frame.height - 14);
  font.draw(image, options.title, {14, 24}, 18, kAxisInk);
  font.draw(image, options.y_label, {14, 43}, 15, kAxisInk);
  font.draw(image, options.x_label, {right - font.width(options.x_label, 15), bottom}, 15, kAxisInk);
}

void draw_curve(Image& image, const Frame& frame, const Curve& curve, const Vec3& color) {
  for (size_t i = 0; i < curve.x.size(); ++i) {
    if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
    const Vector2f here = frame.at(curve.x[i], curve.y[i]);
    draw_line(image, here, here, 8, color);
    if (i > 0 && std::isfinite(curve.x[i - 1]) && std::isfinite(curve.y[i - 1]))
      draw_line(image, frame.at(curve.x[i - 1], curve.y[i - 1]), here, 2.5f, color);
  }
}

}  // namespace

Image plot(const std::vector<Curve>& curves, const PlotOptions& options) {
  const Frame frame = frame_of(curves, options);
  const Font font = Font::system();
  Image image(options.width, options.height, kAxisPaper);
  draw_axes(image, font, frame, options);
  for (size_t i = 0; i < curves.size(); ++i)
    draw_curve(image, frame, curves[i], kColors[i % std::size(kColors)]);
  float x = static_cast<float>(kLeft);
  for (size_t i = 0; curves.size() > 1 && i < curves.size(); ++i) {
    const float y = static_cast<float>(options.height - 19);
    draw_line(image, {x, y}, {x + 22, y}, 3, kColors[i % std::size(kColors)]);
    font.draw(image, curves[i].name, {x + 29, y + 5}, 15, kAxisInk);
    x += 52 + font.width(curves[i].name, 15);
  }
  return image;
}

}  // namespace understudy::render
