#include "retarget/geometry/surface_places.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

Mesh triangle() {
  Mesh mesh;
  mesh.vertices.resize(3, 3);
  mesh.vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  mesh.faces.resize(1, 3);
  mesh.faces << 0, 1, 2;
  return mesh;
}

Vec3 nearest(const Mesh& surface, const Vec3& point) {
  const Points points = point.transpose();
  return nearest_places(surface, points).on(surface.vertices).row(0).transpose();
}

TEST(SurfacePlaces, AreInsideOnEdgesAndInCorners) {
  const Mesh mesh = triangle();
  EXPECT_LT((nearest(mesh, {0.25f, 0.25f, 2}) - Vec3(0.25f, 0.25f, 0)).norm(), 1e-6f);
  EXPECT_LT((nearest(mesh, {0.5f, -1, 1}) - Vec3(0.5f, 0, 0)).norm(), 1e-6f);
  EXPECT_LT((nearest(mesh, {-3, 0.5f, 0}) - Vec3(0, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((nearest(mesh, {1, 1, 1}) - Vec3(0.5f, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((nearest(mesh, {-1, -1, 0}) - Vec3(0, 0, 0)).norm(), 1e-6f);
  EXPECT_LT((nearest(mesh, {3, -1, 0}) - Vec3(1, 0, 0)).norm(), 1e-6f);
  EXPECT_LT((nearest(mesh, {-1, 3, 0}) - Vec3(0, 1, 0)).norm(), 1e-6f);
}

TEST(SurfacePlaces, GoWithTheSurface) {
  Mesh mesh = triangle();
  const Points point = Eigen::RowVector3f(0.25f, 0.5f, 1);
  const SurfacePlaces places = nearest_places(mesh, point);
  mesh.vertices.row(1) << 5, 0, 0;
  EXPECT_LT((places.on(mesh.vertices).row(0) - Eigen::RowVector3f(1.25f, 0.5f, 0)).norm(), 1e-6f);
  RowMatrix weights(3, 2);
  weights << 1, 0, 0, 1, 1, 0;
  EXPECT_NEAR(places.of(weights)(0, 1), 0.25f, 1e-6f);
}

TEST(SurfacePlaces, OfACloudAreItsPoints) {
  Mesh cloud = triangle();
  cloud.faces.resize(0, 3);
  EXPECT_LT((nearest(cloud, {0.7f, 0.1f, 1}) - Vec3(1, 0, 0)).norm(), 1e-6f);
}

TEST(SurfacePlaces, LooseVerticesAreNoSurface) {
  Mesh mesh = triangle();
  mesh.vertices.conservativeResize(4, 3);
  mesh.vertices.row(3) << 0, 0, 5;
  EXPECT_LT((nearest(mesh, {0.1f, 0.1f, 5}) - Vec3(0.1f, 0.1f, 0)).norm(), 1e-6f);
}

TEST(SurfacePlaces, RefuseNothing) {
  EXPECT_THROW(nearest(Mesh{Points(0, 3)}, Vec3::Zero()), Error);
  EXPECT_THROW(nearest(triangle(), Vec3(NAN, 0, 0)), Error);
}

}  // namespace
}  // namespace understudy
