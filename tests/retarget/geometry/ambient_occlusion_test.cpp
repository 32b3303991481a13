#include "retarget/geometry/ambient_occlusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy {
namespace {

/// A ball of `rings` x 2 `rings` vertices.
Mesh make_ball(int rings, float radius) {
  Mesh ball;
  const int around = 2 * rings;
  ball.vertices.resize(rings * around, 3);
  ball.faces.resize(2 * (rings - 1) * around, 3);
  int face = 0;
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const float v = kPi * (static_cast<float>(r) + 0.5f) / static_cast<float>(rings);
      const float u = 2 * kPi * static_cast<float>(k) / static_cast<float>(around);
      ball.vertices.row(r * around + k) << radius * std::sin(v) * std::sin(u), -radius * std::cos(v),
          radius * std::sin(v) * std::cos(u);
      if (r == 0) continue;
      const int a = r * around + k, b = r * around + (k + 1) % around;
      ball.faces.row(face++) << a, a - around, b - around;
      ball.faces.row(face++) << a, b - around, b;
    }
  return ball;
}

Mesh together(const Mesh& a, const Mesh& b) {
  Mesh both;
  both.vertices.resize(a.vertices.rows() + b.vertices.rows(), 3);
  both.vertices << a.vertices, b.vertices;
  both.faces.resize(a.faces.rows() + b.faces.rows(), 3);
  both.faces << a.faces, (b.faces.array() + static_cast<int>(a.vertices.rows())).matrix();
  return both;
}

Eigen::VectorXf light_on(const Mesh& mesh) {
  return ambient_occlusion(mesh.vertices, mesh.faces, vertex_normals(mesh.vertices, mesh.faces));
}

TEST(AmbientOcclusion, LeavesABallInFullLight) {
  const Eigen::VectorXf light = light_on(make_ball(30, 0.5f));
  EXPECT_GT(light.minCoeff(), 0.93f);
  EXPECT_LE(light.maxCoeff(), 1.0001f);
}

TEST(AmbientOcclusion, IsTotalInsideAClosedBall) {
  const Mesh inner = make_ball(16, 0.2f), both = together(inner, make_ball(30, 0.5f));
  const Eigen::VectorXf light = light_on(both);
  const auto count = inner.vertices.rows();
  EXPECT_LT(light.head(count).maxCoeff(), 0.05f);
  EXPECT_GT(light.tail(light.size() - count).mean(), 0.93f);
}

TEST(AmbientOcclusion, DarkensWhereTwoBallsFaceEachOther) {
  Mesh left = make_ball(24, 0.5f), right = left;
  left.vertices.col(0).array() -= 0.52f;
  right.vertices.col(0).array() += 0.52f;
  const Mesh both = together(left, right);
  const Eigen::VectorXf light = light_on(both);
  Eigen::Index facing = 0, away = 0;
  both.vertices.topRows(left.vertices.rows()).col(0).maxCoeff(&facing);
  both.vertices.topRows(left.vertices.rows()).col(0).minCoeff(&away);
  EXPECT_LT(light[facing], 0.25f);
  EXPECT_GT(light[away], 0.93f);
}

TEST(AmbientOcclusion, OfACloudIsFullLight) {
  EXPECT_TRUE(ambient_occlusion(Points::Random(5, 3), Faces(0, 3), Points::Zero(5, 3)).isOnes());
}

TEST(AmbientOcclusion, RefusesWhatDoesNotFit) {
  const Mesh ball = make_ball(4, 1);
  Faces bad = ball.faces;
  bad(0, 0) = 1000;
  const Points normals = vertex_normals(ball.vertices, ball.faces);
  EXPECT_THROW(ambient_occlusion(ball.vertices, bad, normals), Error);
  EXPECT_THROW(ambient_occlusion(ball.vertices, ball.faces, normals.topRows(3)), Error);
}

}  // namespace
}  // namespace understudy
