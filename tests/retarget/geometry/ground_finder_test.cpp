#include "retarget/geometry/ground_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kCell = 0.05f;

/// A level rectangle of points about a place, and a pillar as thick and tall as somebody on it.
Mesh ground_with_pillar(const Vec3& half, float noise, float tilt_deg, float height, int points = 6000) {
  Rng rng(4);
  Mesh cloud;
  cloud.vertices.resize(points + 2000, 3);
  for (int i = 0; i < points; ++i)
    cloud.vertices.row(i) << rng.uniform(-half.x(), half.x()), noise * rng.normal(),
        rng.uniform(-half.z(), half.z());
  for (int i = points; i < points + 2000; ++i) {
    const float a = rng.uniform(0, 2 * kPi);
    cloud.vertices.row(i) << 0.18f * std::cos(a), rng.uniform(0, 1.7f), 0.18f * std::sin(a);
  }
  const Mat3 R = rotation_from_axis_angle(Vec3(0, 0, tilt_deg * kPi / 180));
  cloud.vertices = (cloud.vertices * R.transpose()).rowwise() + Eigen::RowVector3f(0, height, 0);
  return cloud;
}

std::optional<Ground> ground_of(const Mesh& scan) {
  return GroundFinder().push(Cells(scan, kCell));
}

TEST(GroundFinder, FindsHeightAndTiltOfAnySize) {
  for (const float half : {0.5f, 1.5f, 4.0f})
    for (const float tilt : {-8.0f, 0.0f, 5.0f}) {
      const auto ground = ground_of(ground_with_pillar({half, 0, half}, 0.006f, tilt, 0.3f));
      ASSERT_TRUE(ground) << half << " " << tilt;
      EXPECT_NEAR(std::acos(std::min(1.0f, ground->plane.normal.y())) * 180 / kPi, std::abs(tilt), 0.8f)
          << half;
      EXPECT_NEAR(ground->plane.above(Vec3(0, 0.3f, 0)), 0, 0.01f) << half << " " << tilt;
    }
}

TEST(GroundFinder, NoiseMakesItThicker) {
  const auto fine = ground_of(ground_with_pillar({1.5f, 0, 1.5f}, 0.002f, 0, 0, 40000));
  const auto noisy = ground_of(ground_with_pillar({1.5f, 0, 1.5f}, 0.025f, 0, 0, 40000));
  ASSERT_TRUE(fine && noisy);
  EXPECT_NEAR(noisy->plane.height_m, 0, 0.015f);
  EXPECT_GT(noisy->thickness_m, fine->thickness_m + 0.01f);
}

TEST(GroundFinder, FindsAStripSeenFromOneSide) {
  Mesh scan = ground_with_pillar({1.2f, 0, 0.5f}, 0.004f, 0, -0.2f);
  std::vector<char> kept(scan.vertices.rows());
  for (size_t i = 0; i < kept.size(); ++i) kept[i] = scan.vertices(static_cast<Eigen::Index>(i), 2) > 0.05f;
  const auto ground = ground_of(kept_part(scan, kept));
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->plane.above(Vec3(0, -0.2f, 0)), 0, 0.02f);
}

TEST(GroundFinder, FindsNoneUnderAPillarAlone) {
  Mesh scan = ground_with_pillar({1, 0, 1}, 0.004f, 0, 0);
  scan.vertices = scan.vertices.bottomRows(2000).eval();
  EXPECT_FALSE(ground_of(scan));
}

TEST(GroundFinder, TakesTheFloorNotTheTable) {
  Rng rng(2);
  Mesh scan = ground_with_pillar({1, 0, 1}, 0.004f, 0, 0);
  Points table(6000, 3);
  for (auto row : table.rowwise()) row << rng.uniform(0.4f, 1.4f), 0.7f, rng.uniform(-0.5f, 0.5f);
  Points both(scan.vertices.rows() + table.rows(), 3);
  both << scan.vertices, table;
  scan.vertices = both;
  const auto ground = ground_of(scan);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->plane.height_m, 0, 0.01f);
}

TEST(GroundFinder, StaysWhereTheGroundIsHidden) {
  GroundFinder finder;
  const Mesh scan = ground_with_pillar({1, 0, 1}, 0.004f, 0, 0.1f);
  ASSERT_TRUE(finder.push(Cells(scan, kCell)));
  Mesh pillar = scan;
  pillar.vertices = scan.vertices.bottomRows(2000).eval();
  ASSERT_TRUE(finder.push(Cells(pillar, kCell)));
  EXPECT_NEAR(finder.last()->plane.above(Vec3(0, 0.1f, 0)), 0, 0.01f);
}

TEST(Cells, HoldAMeshsTrianglesWhole) {
  Mesh square;
  square.vertices.resize(4, 3);
  square.vertices << 0.01f, 0.01f, 0.01f, 0.99f, 0.01f, 0.01f, 0.99f, 0.01f, 0.99f, 0.01f, 0.01f, 0.99f;
  square.faces.resize(2, 3);
  square.faces << 0, 1, 2, 0, 2, 3;
  const Cells cells(square, 0.1f);
  EXPECT_EQ(cells.count(), 100);
  int sets = 0;
  connected_cells(cells, std::vector<char>(100, 1), &sets);
  EXPECT_EQ(sets, 1);
}

TEST(Cells, PointsTooFarOutAreInNone) {
  Mesh cloud;
  cloud.vertices.resize(3, 3);
  cloud.vertices << 0, 0, 0, NAN, 0, 0, 1e20f, 0, 0;
  const Cells cells(cloud, 0.05f);
  EXPECT_EQ(cells.count(), 1);
  EXPECT_EQ(cells.of_vertex(), (std::vector<int>{0, -1, -1}));
}

}  // namespace
}  // namespace understudy
