#include "render/band_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

/// The columns between which a colour is seen, first and last; {-1, -1} nowhere.
template <class Is>
std::pair<int, int> seen(const Image& image, const Is& is) {
  std::pair<int, int> columns(-1, -1);
  for (int x = 0; x < image.width; ++x)
    for (int y = 70; y < image.height; ++y)
      if (is(image.at(x, y))) columns = {columns.first < 0 ? x : columns.first, x};
  return columns;
}

bool is_orange(const uint8_t* p) {
  return p[0] > p[2] + 100;
}
bool is_band(const uint8_t* p) {
  return p[2] > 215 && p[0] < 175 && p[1] > 180;
}

TEST(BandPlot, WhatComesIntoTheBandLiesInIt) {
  const Image image = band_plot({{"sway", "deg", 1, 1, 6, 5, 6, 8}}, {"Figures"});
  const auto dot = seen(image, is_orange), band = seen(image, is_band);
  EXPECT_GT(dot.first, band.first);
  EXPECT_LT(dot.second, band.second);
  const Image outside = band_plot({{"sway", "deg", 1, 1, 2, 5, 6, 8}}, {"Figures"});
  EXPECT_LT(seen(outside, is_orange).second, seen(outside, is_band).first);
}

TEST(BandPlot, LeavesOutWhatIsNotFinite) {
  const Image image = band_plot({{"rise", "s", 3, NAN, 0.3, NAN, NAN, NAN}}, {"Figures"});
  EXPECT_EQ(seen(image, is_band).first, -1);
  EXPECT_GT(seen(image, is_orange).first, 0);
  band_plot({{"rise", "s", 3, NAN, NAN, NAN, NAN, NAN}}, {"Figures"});
  EXPECT_THROW(band_plot({}, {"Figures"}), Error);
}

}  // namespace
}  // namespace understudy::render
