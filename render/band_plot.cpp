#include "render/band_plot.hpp"

#include <algorithm>
#include <cmath>

#include "render/strokes.hpp"
#include "render/text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::render {
namespace {

constexpr int kBandMargin = 18, kBandHead = 78, kBandRow = 50;  // pixels
constexpr float kBandLetters = 15, kBandDot = 13;
const Vec3 kBandInk(0.13f, 0.15f, 0.18f), kBandLine(0.85f, 0.87f, 0.89f), kBandFill(0.62f, 0.77f, 0.91f),
    kBandMiddle(0.18f, 0.43f, 0.66f), kBeforeInk(0.42f, 0.46f, 0.50f), kAfterInk(0.80f, 0.40f, 0.12f);

void draw_bar(Image& image, float from, float to, float y, const Vec3& color) {
  for (int row = static_cast<int>(y) - 10; row < static_cast<int>(y) + 10; ++row)
    for (int x = static_cast<int>(from); x <= std::min(static_cast<int>(to), image.width - 1); ++x)
      for (int c = 0; c < 3; ++c) image.at(x, row)[c] = static_cast<uint8_t>(255 * color[c] + 0.5f);
}

/// Empty inside where it is of what was before.
void draw_dot(Image& image, const Eigen::Vector2f& at, const Vec3& color, bool hollow) {
  paint(image, {{at, at, kBandDot, kBandDot}}, color);
  if (hollow) paint(image, {{at, at, kBandDot - 5, kBandDot - 5}}, Vec3::Ones());
}

/// Places of one row's values.
struct BandScale {
  float left, width;
  double most = 0;

  BandScale(const BandRow& row, float from, float to) : left(from), width(to - from) {
    for (const double value : {row.before, row.after, row.low, row.middle, row.high})
      if (std::isfinite(value)) most = std::max(most, 1.08 * value);
    if (most <= 0) most = 1;
  }
  float at(double value) const { return left + width * static_cast<float>(value / most); }
};

void draw_row(Image& image, const Font& font, const BandRow& row, const BandScale& scale, float y) {
  font.draw(image, row.name, {kBandMargin, y + 5}, kBandLetters, kBandInk);
  draw_bar(image, scale.left, scale.left + scale.width, y, Vec3::Ones());
  paint(image, {{{scale.left, y}, {scale.left + scale.width, y}, 1, 1}}, kBandLine);
  if (std::isfinite(row.low) && std::isfinite(row.high))
    draw_bar(image, scale.at(row.low), scale.at(row.high), y, kBandFill);
  if (std::isfinite(row.middle))
    draw_bar(image, scale.at(row.middle) - 1, scale.at(row.middle) + 1, y, kBandMiddle);
  const float apart = scale.at(row.after) - scale.at(row.before);  // NaN where one is not there
  for (const auto& [value, color, hollow] :
       {std::tuple{row.before, kBeforeInk, true}, std::tuple{row.after, kAfterInk, false}}) {
    if (!std::isfinite(value)) continue;
    draw_dot(image, {scale.at(value), y}, color, hollow);
    const std::string text = printed("%.*f", row.digits, value) + (row.unit.empty() ? "" : " " + row.unit);
    const float wide = font.width(text, kBandLetters), away = hollow ? apart : -apart;
    const float beside = std::abs(away) < 1.1f * wide ? (away > 0 ? wide - 6 : 6) : 0.5f * wide;
    font.draw(image, text, {scale.at(value) - beside, y + 26}, kBandLetters, color);
  }
}

void draw_legend(Image& image, const Font& font, const BandPlotOptions& options, float x) {
  constexpr float kY = 51;
  draw_dot(image, {x + 7, kY}, kBeforeInk, true);
  font.draw(image, options.before, {x + 20, kY + 5}, kBandLetters, kBandInk);
  x += 48 + font.width(options.before, kBandLetters);
  draw_dot(image, {x, kY}, kAfterInk, false);
  font.draw(image, options.after, {x + 13, kY + 5}, kBandLetters, kBandInk);
  x += 34 + font.width(options.after, kBandLetters);
  draw_bar(image, x, x + 28, kY, kBandFill);
  font.draw(image, options.band, {x + 36, kY + 5}, kBandLetters, kBandInk);
}

}  // namespace

Image band_plot(const std::vector<BandRow>& rows, const BandPlotOptions& options) {
  US_CHECK(!rows.empty(), options.title, ": there is no figure to plot");
  const Font font = Font::system();
  Image image(options.width, kBandHead + kBandRow * static_cast<int>(rows.size()) + 6, Vec3::Ones());
  font.draw(image, options.title, {kBandMargin, 28}, 18, kBandInk);
  float left = 0;
  for (const BandRow& row : rows) left = std::max(left, font.width(row.name, kBandLetters));
  left = std::min(left + 2 * kBandMargin, 0.5f * static_cast<float>(options.width));
  draw_legend(image, font, options, kBandMargin);
  for (size_t i = 0; i < rows.size(); ++i)
    draw_row(image, font, rows[i],
             BandScale(rows[i], left, static_cast<float>(options.width - 2 * kBandMargin)),
             static_cast<float>(kBandHead + kBandRow * static_cast<int>(i)) + 16);
  return image;
}

}  // namespace understudy::render
