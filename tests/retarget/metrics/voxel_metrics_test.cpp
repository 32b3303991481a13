#include "retarget/metrics/voxel_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr double kCell = 2.0 / 63;

Points corners() {
  Points box(2, 3);
  box << 0, 0, 0, 63, 63, 63;  // a cell is a metre
  return box;
}

Points with(const Points& points, float x, float y, float z) {
  Points more = points;
  more.conservativeResize(points.rows() + 1, 3);
  more.row(points.rows()) << x, y, z;
  return more;
}

TEST(VoxelGrid, ReachesFromCornerToCorner) {
  const VoxelGrid grid({corners()});
  EXPECT_EQ(grid.cells(corners()), (VoxelSet{0, 64 * 64 * 64 - 1}));
  const Points centres = VoxelGrid::centres(grid.cells(with(Points(0, 3), 1.2f, 0, 0)));
  EXPECT_NEAR(centres(0, 0), -1 + kCell, 1e-6);
  EXPECT_NEAR(centres(0, 1), -1, 1e-6);
}

TEST(VoxelGrid, HasOneScaleForAllAxes) {
  Points flat(2, 3);
  flat << 0, 0, 0, 63, 3, 3;
  const VoxelGrid grid({flat});
  EXPECT_NEAR(VoxelGrid::centres(grid.cells(flat))(1, 1), 1.5 * kCell, 1e-6);  // three cells apart
}

TEST(VoxelGrid, MayBeCoarser) {
  const VoxelGrid grid({corners()}, 3);
  const Points centres = VoxelGrid::centres(grid.cells(with(Points(0, 3), 20, 0, 0)), 3);
  EXPECT_EQ(centres.row(0), (Eigen::RowVector3f(0, -1, -1))) << "the second of three";
  EXPECT_NEAR(voxel_distance({0}, {1}, 3), 2, 1e-6) << "a cell is half an edge";
  EXPECT_TRUE(grid.world(grid.scaled(corners())).isApprox(corners()));
}

TEST(VoxelGrid, TakesWhatLiesOutsideToItsBorder) {
  const VoxelGrid grid({corners()});
  EXPECT_EQ(grid.cells(with(with(Points(0, 3), -50, 0, 0), NAN, 0, 0)), VoxelSet{0});
}

// One voxel of three is a cell off: (1/3 + 1/3) cell^2.
TEST(VoxelErrors, CountCellsSquaredBothWays) {
  const VoxelGrid grid({corners()});
  const std::vector<VoxelSet> truth = {grid.cells(with(corners(), 30, 0, 0))},
                              found = {grid.cells(with(corners(), 31, 0, 0))};
  EXPECT_NEAR(voxel_errors(found, truth).cd_1e4, 1e4 * 2.0 / 3 * kCell * kCell, 1e-3);
  EXPECT_EQ(voxel_errors(truth, truth).cd_1e4, 0);
  EXPECT_TRUE(std::isnan(voxel_errors(truth, truth).m_cd));
}

// A voxel goes 10 cells, the found one 12: what vanishes agrees, what appears is two cells off both ways.
TEST(VoxelErrors, CompareWhatAppearsAndVanishes) {
  const VoxelGrid grid({corners()});
  const auto at = [&](float x) { return grid.cells(with(corners(), x, 0, 0)); };
  EXPECT_NEAR(voxel_errors({at(20), at(32)}, {at(20), at(30)}).m_cd, 2 * 4 * kCell * kCell, 1e-6);
  EXPECT_EQ(voxel_errors({at(20), at(30)}, {at(20), at(30)}).m_cd, 0);
  EXPECT_EQ(voxel_errors({at(20), at(20)}, {at(20), at(30)}).m_cd, 8);  // nothing moves in the one
}

/// A square of 63 x 63 cells, a corner's cell a quarter as large.
struct Square {
  Points vertices{4, 3};
  Faces faces{2, 3};
  Square() {
    vertices << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
    faces << 0, 1, 2, 0, 2, 3;
  }
};

// 20,000 points on 63 x 63 cells: 5.04 a cell, and exp(-5.04) = 0.65 % of the cells have none; their
// neighbours are a cell away. Cells of the border, 4 of 63, are half as large: 8 % of them have none.
TEST(VoxelErrors, OfTheSameSurfaceAreWhatDrawnPointsMiss) {
  const Square square;
  const std::vector<Points> frames = {square.vertices, square.vertices};
  const VoxelErrors errors = voxel_errors(frames, square.faces, frames, square.faces);
  EXPECT_NEAR(errors.cd_1e4, 1e4 * kCell * kCell * (0.0065 + 2.0 / 63 * 2 * 0.08), 0.04);
  EXPECT_EQ(errors.m_cd, 0);
}

TEST(VoxelErrors, OfASurfaceACellHigherAreACellBothWays) {
  const Square square;
  Points lifted = square.vertices;
  lifted.col(2).array() += 1.0f / 63;
  EXPECT_NEAR(voxel_errors({lifted}, square.faces, {square.vertices}, square.faces).cd_1e4,
              1e4 * 2 * kCell * kCell, 0.2);
}

TEST(VoxelErrors, RefuseWhatCannotBeCompared) {
  EXPECT_THROW(voxel_errors(std::vector<VoxelSet>{}, std::vector<VoxelSet>{}), Error);
  EXPECT_THROW(voxel_errors({VoxelSet{1}}, {VoxelSet{1}, VoxelSet{2}}), Error);
  EXPECT_THROW(VoxelGrid(std::vector<Points>{Points(0, 3)}), Error);
}

}  // namespace
}  // namespace understudy
