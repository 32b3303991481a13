#include <gtest/gtest.h>

#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

TEST(Pts, ReadsPositionsAndColoursOfSeveralScans) {
  const Mesh mesh = parse_mesh("2\n1 2 3 -900 255 0 51\n4 5 6 12 0 0 0\n1\n7 8 9 0 0 255 0\n", "a.PTS");
  ASSERT_EQ(mesh.vertices.rows(), 3);
  EXPECT_EQ(mesh.vertices.row(2), Eigen::RowVector3f(7, 8, 9));
  EXPECT_EQ(mesh.colors.row(0), Eigen::RowVector3f(1, 0, 0.2f));
  EXPECT_TRUE(mesh.is_cloud());
}

TEST(Pts, NeedsNeitherIntensityNorColoursNorACount) {
  EXPECT_EQ(parse_mesh("2\n1 2 3\n4 5 6\n", "a.pts").vertices.rows(), 2);
  EXPECT_EQ(parse_mesh("1\n1 2 3 0.5\n", "a.pts").colors.rows(), 0);
  EXPECT_EQ(parse_mesh("1\n1 2 3 255 255 255\n", "a.pts").colors(0, 2), 1);
  EXPECT_EQ(parse_mesh("1 2 3\n4 5 6\n", "a.pts").vertices.rows(), 2);
}

TEST(Pts, RefusesWhatIsCutOffOrAnnouncesMoreThanItHolds) {
  const std::string whole = "3\n0 0 1\n1 0 0\n0 1 0\n";
  EXPECT_EQ(error_of([&] { parse_mesh(whole.substr(0, 14), "a.pts"); }), "a.pts: ends before point 3 of 3");
  EXPECT_EQ(error_of([] { parse_mesh("9000000000000000000\n1 2 3\n", "a.pts"); }),
            "a.pts: announces 9000000000000000000 points, but is too short for them");
  EXPECT_EQ(error_of([] { parse_mesh("1\n1 2\n", "a.pts"); }), "a.pts: '1 2' is not a point");
  EXPECT_EQ(error_of([] { parse_mesh("1\n1 2 x\n", "a.pts"); }), "a.pts: 'x' is not a number");
  EXPECT_EQ(error_of([] { parse_mesh("1\n1 2 3\n4 5 6\n", "a.pts"); }),
            "a.pts: '4 5 6' is not a count of points");
  EXPECT_EQ(error_of([] { parse_mesh("0\n", "a.pts"); }), "a.pts: has no points in it");
}

TEST(Pts, IsAFrameOfAScanAndATarget) {
  EXPECT_STREQ(format_of_suffix("frame_1.Pts", kScanFrame)->name, "PTS");
  EXPECT_TRUE(can_be("body.pts", kTarget));
}

}  // namespace
}  // namespace understudy
