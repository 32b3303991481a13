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

TEST(VoxelErrors, OfTheSameSurfaceAreNone) {
  Points square(4, 3);
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  Faces faces(2, 3);
  faces << 0, 1, 2, 0, 2, 3;
  const std::vector<Points> frames = {square, square};
  EXPECT_EQ(voxel_errors(frames, faces, frames, faces).cd_1e4, 0);
  Points lifted = square;
  lifted.col(2).array() += 1.0f / 63;
  const double one_cell = voxel_errors({lifted, lifted}, faces, frames, faces).cd_1e4;
  EXPECT_NEAR(one_cell, 1e4 * 2 * kCell * kCell, 0.5);
}

TEST(VoxelErrors, RefuseWhatCannotBeCompared) {
  EXPECT_THROW(voxel_errors(std::vector<VoxelSet>{}, std::vector<VoxelSet>{}), Error);
  EXPECT_THROW(voxel_errors({VoxelSet{1}}, {VoxelSet{1}, VoxelSet{2}}), Error);
  EXPECT_THROW(VoxelGrid(std::vector<Points>{Points(0, 3)}), Error);
}

}  // namespace
}  // namespace understudy
