#include "render/pose_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/contact_sheet.hpp"
#include "retarget/base/error.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy::render {
namespace {

/// Pixels of a column range that are grey, but not black.
int grey_pixels(const Image& image, int from, int to) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = from; x < to; ++x) {
      const uint8_t* at = image.at(x, y);
      count += at[0] == 120 && at[1] == 120 && at[2] == 120;
    }
  return count;
}

int brightest(const Image& image) {
  return *std::max_element(image.pixels.begin(), image.pixels.end());
}

TEST(PoseCell, FillsItsWidthWithTheViewWhereverThatLies) {
  const FlatPose near = flat_person(300), far = flat_person(2300);
  PoseCell a, b;
  a.performer = near, b.performer = far;
  EXPECT_EQ(pose_cell(a, view_of({near}), 120, 200).pixels, pose_cell(b, view_of({far}), 120, 200).pixels);
}

TEST(PoseCell, OthersAreFaintAndTheTruthIsGreyBelowWhoPerforms) {
  const FlatPose pose = flat_person();
  PoseCell faint;
  faint.others = {pose};
  EXPECT_LT(brightest(pose_cell(faint, view_of({pose}), 120, 200)), 90);
  PoseCell truth;
  truth.truth = pose;
  const Image alone = pose_cell(truth, view_of({pose}), 120, 200);
  truth.performer = pose;
  const Image both = pose_cell(truth, view_of({pose}), 120, 200);
  EXPECT_GT(grey_pixels(both, 0, 120), 100) << "it is wider";
  EXPECT_LT(grey_pixels(both, 0, 120), grey_pixels(alone, 0, 120));
}

TEST(PoseCell, AWipeHasOneLeftOfItsLineAndTheOtherRight) {
  const FlatPose pose = flat_person(), tall = flat_person(300, 1.3f);
  const FlatBox view = view_of({pose, tall});
  PoseCell left, right, wiped;
  left.performer = wiped.left = tall;
  right.performer = wiped.performer = pose;
  const Image a = pose_cell(left, view, 120, 200), b = pose_cell(right, view, 120, 200),
              both = pose_cell(wiped, view, 120, 200);
  ASSERT_NE(a.pixels, b.pixels);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 120; ++x) {
      if (x == 60) continue;
      ASSERT_TRUE(std::equal(both.at(x, y), both.at(x, y) + 3, (x < 60 ? a : b).at(x, y))) << x << " " << y;
    }
}

TEST(PoseCell, ThePictureBehindLiesWhereThePoseDoes) {
  const FlatPose pose = flat_person();
  auto picture = std::make_shared<Image>(640, 480, Vec3::Zero());
  for (int y = 0; y < 480; ++y) std::fill_n(picture->at(0, y), 3 * 300, uint8_t{200});  // left of the person
  PoseCell cell;
  cell.behind = picture;
  const Image image = pose_cell(cell, view_of({pose}), 120, 200);
  EXPECT_EQ(image.at(10, 100)[0], 90);
  EXPECT_EQ(image.at(110, 100)[0], 0);
}

TEST(PoseCell, RefusesAViewOfNobody) {
  EXPECT_TRUE(view_of({FlatPose()}).isEmpty());
  EXPECT_THROW(pose_cell({}, FlatBox(), 120, 200), Error);
}

TEST(PictureSheet, HasAColumnForEachHeaderAndRefusesAnotherNumber) {
  StripOptions options;
  options.width = 700;
  const int width = picture_width(options, 3);
  PictureRow row{"a", std::vector<Image>(3, Image(width, 50, Vec3(1, 0, 0)))};
  const Image sheet = picture_sheet({row, row}, {"x", "y", "z"}, options);
  EXPECT_EQ(sheet.width, 700);
  int red = 0;
  for (size_t i = 0; i < sheet.pixels.size(); i += 3)
    red += sheet.pixels[i] == 255 && sheet.pixels[i + 1] == 0;
  EXPECT_EQ(red, 2 * 3 * width * 50);
  EXPECT_THROW(picture_sheet({row}, {"x", "y"}, options), Error);
  EXPECT_THROW(picture_sheet({}, {"x"}, options), Error);
}

}  // namespace
}  // namespace understudy::render
