// Clouds are thinned evenly.
#include <gtest/gtest.h>

#include <limits>

#include "retarget/geometry/mesh.hpp"

namespace understudy {
namespace {

/// Points in a row, a colour each, the first `lost` of them not finite.
Mesh row_of(Eigen::Index count, Eigen::Index lost = 0) {
  Mesh cloud;
  cloud.vertices.setZero(count, 3);
  cloud.vertices.col(0).setLinSpaced(count, 0, static_cast<float>(count - 1));
  cloud.colors = cloud.vertices / static_cast<float>(count);
  cloud.vertices.topRows(lost).setConstant(std::numeric_limits<float>::quiet_NaN());
  return cloud;
}

TEST(ThinCloud, KeepsOneOfEachRunWithItsColour) {
  Mesh cloud = row_of(1000);
  thin_cloud(cloud, 300);
  ASSERT_EQ(cloud.vertices.rows(), 250);
  ASSERT_EQ(cloud.colors.rows(), 250);
  bool in_step = true;
  for (Eigen::Index i = 0; i < 250; ++i) {
    const float x = cloud.vertices(i, 0);
    EXPECT_EQ(static_cast<Eigen::Index>(x) / 4, i);
    EXPECT_FLOAT_EQ(cloud.colors(i, 0), x / 1000);
    in_step &= static_cast<Eigen::Index>(x) % 4 == static_cast<Eigen::Index>(cloud.vertices(0, 0)) % 4;
  }
  EXPECT_FALSE(in_step) << "points that come in rows would become stripes";
}

TEST(ThinCloud, CountsWhatIsFiniteAlone) {
  Mesh cloud = row_of(1000, 900);
  thin_cloud(cloud, 50);
  EXPECT_EQ(cloud.vertices.rows(), 50);
  EXPECT_TRUE(cloud.vertices.allFinite());
  Mesh few = row_of(1000, 960);
  thin_cloud(few, 50);
  EXPECT_EQ(few.vertices.rows(), 1000) << "as it was read";
}

TEST(ThinCloud, LeavesMeshesAndSmallClouds) {
  Mesh small = row_of(100), mesh = row_of(100);
  thin_cloud(small, 100);
  EXPECT_EQ(small.vertices.rows(), 100);
  mesh.faces.resize(1, 3);
  mesh.faces << 0, 1, 2;
  thin_cloud(mesh, 10);
  EXPECT_EQ(mesh.vertices.rows(), 100);
}

}  // namespace
}  // namespace understudy
