#include "render/colors.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::render {
namespace {

Vec3 hex(int rgb) {
  return Vec3((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255) / 255.f;
}

const Vec3 kNoValue(0.5f, 0.5f, 0.5f);
using Polynomial = std::array<Vec3, 7>;  // of t, constant first

Vec3 along(const Polynomial& c, float t) {
  if (std::isnan(t)) return kNoValue;
  t = std::clamp(t, 0.f, 1.f);
  Vec3 color = c[6];
  for (int k = 5; k >= 0; --k) color = color * t + c[k];
  return color.cwiseMax(0.f).cwiseMin(1.f);
}

}  // namespace

const Vec3 kLeftColor = hex(0x0072B2), kRightColor = hex(0xE68A00), kMiddleColor = hex(0x50565F);

const std::array<Vec3, 22> kCategories = {
    hex(0xF2F3F4), hex(0x4F5B73), hex(0xF3C300), hex(0x875692), hex(0xF38400), hex(0xA1CAF1),
    hex(0xBE0032), hex(0xC2B280), hex(0x848482), hex(0x008856), hex(0xE68FAC), hex(0x0067A5),
    hex(0xF99379), hex(0x604E97), hex(0xF6A600), hex(0xB3446C), hex(0xDCD300), hex(0x882D17),
    hex(0x8DB600), hex(0x654522), hex(0xE25822), hex(0x2B3D26)};

// Matt Zucker's sixth-degree fits to matplotlib's tables; within 0.01 of viridis, 0.02 of magma.
Vec3 viridis(float t) {
  static const Polynomial c = {{{0.2777273f, 0.0054073f, 0.3340998f},
                                {0.1050930f, 1.4046135f, 1.3845902f},
                                {-0.3308618f, 0.2148476f, 0.0950952f},
                                {-4.6342305f, -5.7991010f, -19.3324410f},
                                {6.2282699f, 14.1799334f, 56.6905526f},
                                {4.7763850f, -13.7451454f, -65.3530326f},
                                {-5.4354559f, 4.6458526f, 26.3124352f}}};
  return along(c, t);
}

Vec3 error_color(float t) {
  static const Polynomial c = {{{-0.0021365f, -0.0007497f, -0.0053861f},
                                {0.2516605f, 0.6775232f, 2.4940266f},
                                {8.3537173f, -3.5777195f, 0.3144679f},
                                {-27.6687331f, 14.2647308f, -13.6492132f},
                                {52.1761398f, -27.9436061f, 12.9441694f},
                                {-50.7685254f, 29.0465828f, 4.2341530f},
                                {18.6557051f, -11.4897735f, -5.6019615f}}};
  return std::isnan(t) ? kNoValue : along(c, 1 - 0.85f * std::clamp(t, 0.f, 1.f));
}

Vec3 diverging_color(float t) {
  static const std::array<Vec3, 5> stops = {hex(0x2166AC), hex(0x92C5DE), hex(0xF4F4F2), hex(0xF5B363),
                                            hex(0xA85106)};
  if (std::isnan(t)) return kNoValue;
  const float at = 4 * std::clamp(t, 0.f, 1.f);
  const size_t k = std::min<size_t>(3, static_cast<size_t>(at));
  return stops[k] + (at - static_cast<float>(k)) * (stops[k + 1] - stops[k]);
}

Vec3 time_color(float t) {
  static const std::array<Vec3, 3> stops = {hex(0x3B4CC0), hex(0xDCDDDD), hex(0xB40426)};
  if (std::isnan(t)) return kNoValue;
  const float at = 2 * std::clamp(t, 0.f, 1.f);
  const size_t k = at < 1 ? 0 : 1;
  return stops[k] + (at - static_cast<float>(k)) * (stops[k + 1] - stops[k]);
}

Points colors_along(Vec3 (*scale)(float), const Eigen::VectorXf& values, float low, float high) {
  Points colors(values.size(), 3);
  const float range = high > low ? high - low : 1.f;
  for (Eigen::Index i = 0; i < values.size(); ++i) colors.row(i) = scale((values[i] - low) / range);
  return colors;
}

Points weight_colors(const RowMatrix& weights) {
  RowMatrix categories(weights.cols(), 3);
  for (Eigen::Index j = 0; j < weights.cols(); ++j) categories.row(j) = kCategories[j % kCategories.size()];
  return Points(weights * categories).cwiseMax(0.f).cwiseMin(1.f);
}

}  // namespace understudy::render
