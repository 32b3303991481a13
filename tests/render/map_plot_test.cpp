#include "render/map_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/strokes.hpp"
#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"

namespace understudy::render {
namespace {

const Vec3 kRed(0.9f, 0.1f, 0.1f), kBlue(0.1f, 0.2f, 0.9f);

int pixels_like(const Image& image, const Vec3& color) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      count +=
          std::abs(image.at(x, y)[0] / 255.f - color[0]) + std::abs(image.at(x, y)[2] / 255.f - color[2]) <
          0.3f;
  return count;
}

std::vector<MapPoint> two() {
  return {{{-1, 0}, kRed}, {{1, 1}, kBlue}};
}

TEST(Strokes, ThatOverlapAreNoDenserThanOne) {
  Image once(20, 20), twice(20, 20);
  const Stroke stroke{{4, 10}, {16, 10}, 6, 6};
  paint(once, {stroke}, Vec3::Zero(), 0.5f);
  paint(twice, {stroke, stroke}, Vec3::Zero(), 0.5f);
  EXPECT_EQ(once.pixels, twice.pixels);
  EXPECT_NEAR(once.at(10, 10)[0], 128, 1);
  EXPECT_EQ(once.at(10, 2)[0], 255);
}

TEST(Strokes, OutsideOfThePictureOrNotFiniteAreLeftOut) {
  Image image(20, 20);
  const Image before = image;
  paint(image, {{{-50, 5}, {-30, 5}, 4, 4}, {{NAN, 5}, {3, 5}, 4, 4}, {{300, 500}, {301, 500}, 4, 4}},
        Vec3::Zero());
  EXPECT_EQ(image.pixels, before.pixels);
}

TEST(MapPlot, DrawsEachPointInItsColour) {
  const Image image = map_plot(two(), {});
  EXPECT_GT(pixels_like(image, 0.5f * kRed + Vec3::Constant(0.5f)), 5);
  EXPECT_GT(pixels_like(image, 0.5f * kBlue + Vec3::Constant(0.5f)), 5);
}

TEST(MapPlot, DrawsFiguresWhereThereIsRoomAndEachMarkedOne) {
  MapPlotOptions options;
  int asked = 0;
  options.figure = [&](int) {
    ++asked;
    return std::vector<Joints>(3, make_joints());
  };
  const int with = pixels_like(map_plot(two(), options), kRed);
  EXPECT_GT(with, 400);
  EXPECT_EQ(asked, 2);
  std::vector<MapPoint> crowd(500, two()[0]);
  crowd.push_back(two()[1]);
  asked = 0;
  map_plot(crowd, options);
  EXPECT_LE(asked, 4) << "those behind others are not made";
  options.marked = {3, 4, 5};
  EXPECT_GT(pixels_like(map_plot(crowd, options), Vec3(0.13f, 0.15f, 0.18f)), 100) << "rings";
}

TEST(MapPlot, OfOnePointOrManyAtOnePlaceIsDrawn) {
  EXPECT_EQ(map_plot({two()[0]}, {}).width, 1600);
  EXPECT_EQ(map_plot({two()[0], two()[0]}, {}).height, 1100);
}

TEST(MapPlot, RefusesNothingAndWhatIsNotFinite) {
  EXPECT_THROW(map_plot({}, {}), Error);
  EXPECT_THROW(map_plot({{{NAN, 0}, kRed}}, {}), Error);
}

}  // namespace
}  // namespace understudy::render
