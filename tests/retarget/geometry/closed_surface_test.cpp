#include "retarget/geometry/closed_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/union_find.hpp"

namespace understudy {
namespace {

/// Points of an ellipsoid with half axes 0.5, 0.2, 0.2 m, moved by `noise` along their normals.
OrientedPoints egg(int count, float noise, float bare_below = -1) {
  Rng rng(5);
  std::vector<Vec3> points, normals;
  const Vec3 half(0.5f, 0.2f, 0.2f);
  while (static_cast<int>(points.size()) < count) {
    const Vec3 on(rng.normal(), rng.normal(), rng.normal());
    const Vec3 unit = on.normalized(), at = unit.cwiseProduct(half);
    if (at.y() < bare_below) continue;
    const Vec3 normal = unit.cwiseQuotient(half).normalized();
    points.push_back(at + noise * rng.normal() * normal);
    normals.push_back(normal);
  }
  OrientedPoints cloud{Points(count, 3), Points(count, 3)};
  for (int i = 0; i < count; ++i) {
    cloud.points.row(i) = points[static_cast<size_t>(i)].transpose();
    cloud.normals.row(i) = normals[static_cast<size_t>(i)].transpose();
  }
  return cloud;
}

/// How far a vertex is from the ellipsoid, about.
float off_egg(const Eigen::RowVector3f& v) {
  const Vec3 scaled = v.transpose().cwiseQuotient(Vec3(0.5f, 0.2f, 0.2f));
  return std::abs(scaled.norm() - 1) * 0.2f;
}

int pieces(const Mesh& mesh) {
  UnionFind sets(static_cast<size_t>(mesh.vertices.rows()));
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 1; c < 3; ++c) sets.join(mesh.faces(f, 0), mesh.faces(f, c));
  int count = 0;
  for (int v = 0; v < mesh.vertices.rows(); ++v) count += sets.root(v) == v;
  return count;
}

TEST(ClosedSurface, LiesInTheMiddleOfNoisyPoints) {
  const Mesh mesh = closed_surface(egg(12000, 0.006f), 3000);
  EXPECT_TRUE(is_closed(mesh.faces));
  EXPECT_EQ(pieces(mesh), 1);
  EXPECT_NEAR(static_cast<double>(mesh.vertices.rows()), 3000, 1000);
  double sum = 0;
  for (const auto& v : mesh.vertices.rowwise()) sum += static_cast<double>(off_egg(v));
  EXPECT_LT(sum / static_cast<double>(mesh.vertices.rows()), 0.003);
  const Points normals = vertex_normals(mesh.vertices, mesh.faces);  // outwards
  EXPECT_GT(normals.cwiseProduct(mesh.vertices).rowwise().sum().minCoeff(), 0);
}

TEST(ClosedSurface, ClosesWhatWasNotSeen) {
  const Mesh mesh = closed_surface(egg(9000, 0, -0.12f), 3000);  // open below
  EXPECT_TRUE(is_closed(mesh.faces));
  EXPECT_EQ(pieces(mesh), 1);
  EXPECT_LT(mesh.vertices.col(1).minCoeff(), -0.1f);
}

TEST(ClosedSurface, KeepsBodiesApartThatAreHardlyFurtherThanTheirPoints) {
  OrientedPoints two = egg(9000, 0), other = two;
  other.points.col(1).array() += 0.42f;  // 2 cm between them
  two.points.conservativeResize(18000, 3);
  two.normals.conservativeResize(18000, 3);
  two.points.bottomRows(9000) = other.points;
  two.normals.bottomRows(9000) = other.normals;
  EXPECT_EQ(pieces(closed_surface(two, 6000)), 2);
}

TEST(ClosedSurface, RefusesWhatEnclosesNothing) {
  EXPECT_THROW(closed_surface(egg(20, 0), 1000), Error);
  OrientedPoints one_place = egg(3000, 0);
  one_place.points.setOnes();
  EXPECT_THROW(closed_surface(one_place, 1000), Error);
}

}  // namespace
}  // namespace understudy
