#include "render/contact_sheet.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"
#include "tests/render/pictures.hpp"

namespace understudy::render {
namespace {

std::vector<SheetMoment> moments(int count, bool with_target) {
  std::vector<SheetMoment> result;
  for (int i = 0; i < count; ++i) {
    SheetMoment moment;
    moment.frame = 10 * i;
    moment.seconds = i / 3.0;
    moment.source = make_pear(40, 56, 1.75f);
    moment.source.vertices.col(2).array() += 0.6f * static_cast<float>(i);  // it walks
    Joints joints = make_joints();
    joints.col(2).array() += 0.6f * static_cast<float>(i);
    moment.skeleton = skeleton_view(joints);
    if (with_target) moment.target = make_pear(40, 56, 1.1f);
    result.push_back(moment);
  }
  return result;
}

bool is_red(const uint8_t* pixel) {
  return pixel[0] > 2 * pixel[1] && pixel[0] > 2 * pixel[2] && pixel[0] > 40;
}

/// Runs of rows (or columns) in which anything red is seen.
std::vector<std::pair<int, int>> red_runs(const Image& image, bool rows) {
  std::vector<std::pair<int, int>> runs;
  bool inside = false;
  for (int i = 0; i < (rows ? image.height : image.width); ++i) {
    bool red = false;
    for (int k = 0; k < (rows ? image.width : image.height); ++k)
      red = red || is_red(rows ? image.at(k, i) : image.at(i, k));
    if (red && !inside) runs.push_back({i, i});
    if (red) runs.back().second = i;
    inside = red;
  }
  return runs;
}

SheetOptions red(int width) {
  SheetOptions options;
  options.width = width;
  options.title = "Pears";
  options.source_color = options.target_color = Vec3(0.9f, 0.02f, 0.02f);
  return options;
}

TEST(ContactSheet, HasARowForEachViewOfSourceAndTargetAndAColumnForEachMoment) {
  const Image sheet = contact_sheet(moments(4, true), red(700));
  EXPECT_EQ(sheet.width, 700);
  EXPECT_EQ(red_runs(sheet, /*rows=*/true).size(), 4u);
  EXPECT_EQ(red_runs(sheet, /*rows=*/false).size(), 4u);  // none touches its neighbour: nobody is cut
}

TEST(ContactSheet, KeepsOneScaleForSourceAndTarget) {
  const auto rows = red_runs(contact_sheet(moments(2, true), red(700)), true);
  ASSERT_EQ(rows.size(), 4u);
  const auto height = [&](size_t row) { return static_cast<float>(rows[row].second - rows[row].first + 1); };
  EXPECT_NEAR(height(1) / height(0), 1.1f / 1.75f, 0.04f);
  EXPECT_NEAR(height(3) / height(2), 1.1f / 1.75f, 0.04f);
}

TEST(ContactSheet, WithoutTargetsGoesOnBelow) {
  SheetOptions options = red(700);
  options.columns = 4;
  const Image sheet = contact_sheet(moments(7, false), options);
  EXPECT_EQ(red_runs(sheet, true).size(), 4u);  // two bands of two views
}

TEST(ContactSheet, FollowsTheHeading) {
  SheetOptions ahead = red(300), aside = red(300);
  aside.heading = kPi / 2;
  const auto moment = moments(1, false);
  EXPECT_GT(difference(contact_sheet(moment, ahead), contact_sheet(moment, aside)), 0.02);
}

TEST(ContactSheet, OfCloudsAndBadJointsIsStillDrawn) {
  auto strange = moments(3, true);
  strange[0].source.faces.resize(0, 3);
  strange[1].source = Mesh{};
  strange[1].skeleton.reset();
  strange[2].skeleton->joints(4, 1) = std::nanf("");
  strange[2].target.reset();
  EXPECT_GT(red_runs(contact_sheet(strange, red(400)), true).size(), 2u);
}

TEST(ContactSheet, StraysDoNotMakeEveryoneSmall) {
  auto clean = moments(2, false), strayed = clean;
  strayed[0].source.vertices.row(5) << 9, 4, 9;
  EXPECT_EQ(contact_sheet(clean, red(400)).height, contact_sheet(strayed, red(400)).height);
}

/// A pear of each height, walking, until its end.
std::vector<StripRow> strip_rows(const std::vector<float>& heights, size_t moments) {
  std::vector<StripRow> rows;
  for (const float height : heights) {
    rows.push_back({"pear", std::vector<StripMoment>(moments), Vec3(0.9f, 0.02f, 0.02f)});
    for (size_t i = 0; i < moments; ++i) {
      rows.back().moments[i].mesh = make_pear(40, 56, height);
      rows.back().moments[i].mesh.vertices.col(2).array() += 0.6f * static_cast<float>(i);
    }
  }
  return rows;
}

TEST(Strip, HasARowForEachPerformerAtOneScaleAndAColumnForEachTime) {
  const Image image = strip(strip_rows({1.75f, 1.1f}, 3), {0, 0.5, 1}, {"", 700});
  const auto rows = red_runs(image, true);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(red_runs(image, false).size(), 3u);
  const auto height = [&](size_t row) { return static_cast<float>(rows[row].second - rows[row].first + 1); };
  EXPECT_NEAR(height(1) / height(0), 1.1f / 1.75f, 0.05f);
}

TEST(Strip, AtOneTimePerformersStandSideBySide) {
  const Image image = strip(strip_rows({1.75f, 1.1f, 1.2f}, 1), {0.5}, {"", 700});
  EXPECT_EQ(red_runs(image, true).size(), 1u);
  EXPECT_EQ(red_runs(image, false).size(), 3u);
}

TEST(Strip, WhoHasEndedIsNotShown) {
  auto rows = strip_rows({1.75f, 1.75f}, 3);
  rows[0].moments[2] = rows[1].moments[2] = {};
  EXPECT_EQ(red_runs(strip(rows, {0, 1, 2}, {"", 700}), false).size(), 2u);
}

TEST(Strip, RefusesNobodyAndAnotherNumberOfMoments) {
  EXPECT_THROW(strip({}, {0, 1}), Error);
  EXPECT_THROW(strip({{"nobody", std::vector<StripMoment>(2)}}, {0, 1}), Error);
  EXPECT_THROW(strip(strip_rows({1.75f}, 3), {0, 1}), Error);
}

TEST(ContactSheet, RefusesNothingAndNoRoom) {
  EXPECT_THROW(contact_sheet(std::vector<SheetMoment>{}), Error);
  EXPECT_THROW(contact_sheet(std::vector<SheetMoment>(2)), Error);
  EXPECT_THROW(contact_sheet(moments(6, false), red(60)), Error);
}

}  // namespace
}  // namespace understudy::render
