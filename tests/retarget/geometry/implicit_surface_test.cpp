#include "retarget/geometry/implicit_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

/// A ball of 0.2 m about (0.1, 0, 0) with another that is nowhere mirrored.
ImplicitSolid two_balls() {
  ImplicitSolid solid;
  solid.value = [](const Vec3& p) {
    const float a = (p - Vec3(0.1f, 0, 0)).norm() - 0.2f, b = (p - Vec3(-0.15f, 0.2f, 0.05f)).norm() - 0.15f;
    const float near = std::max(0.05f - std::abs(a - b), 0.0f);
    return std::min(a, b) - near * near / 0.2f;
  };
  solid.warp = [](const Vec3& p) { return p; };
  solid.detail = [](const Vec3&) { return 1.0f; };
  solid.low = Vec3(-0.4f, -0.3f, -0.3f);
  solid.high = Vec3(0.4f, 0.45f, 0.3f);
  solid.mirrored = false;
  return solid;
}

TEST(ImplicitSurface, ASolidThatIsNotMirroredIsClosedAndLiesOnItsSurface) {
  const ImplicitSolid solid = two_balls();
  const Mesh mesh = polygonise(solid);
  EXPECT_TRUE(is_closed(mesh.faces));
  EXPECT_EQ(mesh.vertices.rows() - mesh.faces.rows() / 2, 2);
  EXPECT_LT(mesh.vertices.col(0).minCoeff(), -0.29f);
  EXPECT_GT(mesh.vertices.col(0).maxCoeff(), 0.29f);
  float farthest = 0;
  double volume = 0;
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
    farthest = std::max(farthest, std::abs(solid.value(mesh.vertices.row(v).transpose())));
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto corner = [&](int c) -> Vec3 { return mesh.vertices.row(mesh.faces(f, c)).transpose(); };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  EXPECT_LT(farthest, 0.001f);
  EXPECT_GT(volume, 0.03);  // the larger ball alone has 0.0335
}

TEST(ImplicitSurface, HasAboutAsManyVerticesAsAskedFor) {
  ImplicitSolid solid = two_balls();
  for (const int wanted : {1200, 2500}) {
    solid.vertices = wanted;
    EXPECT_NEAR(static_cast<float>(polygonise(solid).vertices.rows()), wanted, 0.25f * wanted);
  }
}

TEST(ImplicitSurface, AMirroredSolidIsTheSameOnBothSides) {
  ImplicitSolid solid = two_balls();
  solid.value = [](const Vec3& p) {
    return (Vec3(std::abs(p.x()), p.y(), p.z()) - Vec3(0.1f, 0, 0)).norm() - 0.2f;
  };
  solid.low.x() = 0;
  solid.mirrored = true;
  const Mesh mesh = polygonise(solid);
  EXPECT_TRUE(is_closed(mesh.faces));
  EXPECT_EQ(mesh.vertices.col(0).minCoeff(), -mesh.vertices.col(0).maxCoeff());
}

TEST(ImplicitSurface, ABoxWithoutSurfaceIsRefused) {
  ImplicitSolid solid = two_balls();
  solid.value = [](const Vec3&) { return 1.0f; };
  EXPECT_THROW(polygonise(solid), Error);
}

}  // namespace
}  // namespace understudy
