#include "render/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

/// Pixels in which blue is much stronger than red: the first curve's.
int blue_pixels(const Image& image, int from_row, int to_row) {
  int count = 0;
  for (int y = from_row; y < to_row; ++y)
    for (int x = 0; x < image.width; ++x) count += image.at(x, y)[2] > image.at(x, y)[0] + 60;
  return count;
}

TEST(Plot, DrawsHighValuesHigh) {
  const PlotOptions options{"title", "x", "y", 300, 300};
  const Image low = plot({{"a", {0, 1, 2, 3, 4}, {1, 1, 1, 1, 10}}}, options);
  const Image high = plot({{"a", {0, 1, 2, 3, 4}, {9, 9, 9, 9, 10}}}, options);
  EXPECT_GT(2 * blue_pixels(high, 50, 120), 3 * blue_pixels(low, 50, 120));
  EXPECT_GT(blue_pixels(low, 180, 300), 3 * blue_pixels(high, 180, 300));
}

TEST(Plot, LeavesOutWhatIsNotFinite) {
  const PlotOptions options{"title", "x", "y", 200, 200};
  EXPECT_GT(blue_pixels(plot({{"a", {0, 1, 2}, {1, NAN, 2}}}, options), 0, 200), 10);
  EXPECT_THROW(plot({{"a", {0}, {NAN}}}, options), Error);
  EXPECT_THROW(plot({{"a", {0, 1}, {1}}}, options), Error);
}

}  // namespace
}  // namespace understudy::render
