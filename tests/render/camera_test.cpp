#include "render/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/render/content.hpp"

namespace understudy::render {
namespace {

/// Place in the picture, -1..1, and depth.
Vec3 seen(const Camera& camera, const Vec3& point, float aspect) {
  const Eigen::Vector4f clip = projection_matrix(camera, aspect) * view_matrix(camera) * point.homogeneous();
  return clip.hnormalized();
}

TEST(Camera, YawZeroSeesTheFrontWithLeftOnTheRight) {
  Camera camera;
  camera.pitch = 0;
  EXPECT_GT(eye(camera).z(), 0);
  EXPECT_GT(seen(camera, camera.target + Vec3::UnitX(), 1).x(), 0);
  EXPECT_GT(seen(camera, camera.target + Vec3::UnitY() * 0.5f, 1).y(), 0);
  EXPECT_LT(seen(camera, camera.target + Vec3::UnitZ(), 1).z(), seen(camera, camera.target, 1).z());
}

TEST(Camera, AQuarterTurnLooksFromPlusX) {
  Camera camera;
  camera.pitch = 0;
  camera = orbited(camera, kPi / 2, 0);
  EXPECT_TRUE(eye(camera).isApprox(camera.target + camera.distance * Vec3::UnitX(), 1e-5f));
}

TEST(Camera, AxesAreARotation) {
  Camera camera;
  camera.yaw = 2.1f;
  camera.pitch = -0.7f;
  const Mat3 R = axes(camera);
  EXPECT_TRUE((R.transpose() * R).isIdentity(1e-5f));
  EXPECT_NEAR(R.determinant(), 1, 1e-5);
}

TEST(Camera, PitchStopsShortOfThePoles) {
  const Camera camera = orbited(Camera(), 0, 100);
  EXPECT_LT(camera.pitch, kPi / 2);
  EXPECT_TRUE(axes(camera).allFinite());
}

class FittedCamera : public testing::TestWithParam<std::tuple<bool, float>> {};

TEST_P(FittedCamera, SeesEveryPointAndTouchesTheMargin) {
  const auto [orthographic, aspect] = GetParam();
  const Points points = make_pear().vertices;
  Camera camera;
  camera.yaw = 0.8f;
  camera.pitch = 0.4f;
  camera.orthographic = orthographic;
  camera = fitted(camera, points, aspect, 0.1f);
  float most = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    most = std::max(most, seen(camera, points.row(i), aspect).head<2>().cwiseAbs().maxCoeff());
  EXPECT_NEAR(most, 0.8f, 1e-3f);
}

INSTANTIATE_TEST_SUITE_P(LensesAndShapes, FittedCamera,
                         testing::Combine(testing::Bool(), testing::Values(0.5f, 1.f, 2.f)));

TEST(Camera, OrthographicKeepsTheSizeAtTheTarget) {
  Camera perspective, orthographic;
  orthographic.orthographic = true;
  const Vec3 beside = perspective.target + 0.7f * axes(perspective).col(0);
  EXPECT_NEAR(seen(perspective, beside, 1.5f).x(), seen(orthographic, beside, 1.5f).x(), 1e-5);
}

TEST(Camera, ARayGoesThroughThePlaceOfItsPoint) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.yaw = 0.4f;
    camera.orthographic = orthographic;
    const Vec3 point(0.3f, 1.2f, -0.4f);
    const Ray ray = ray_through(camera, 1.3f, seen(camera, point, 1.3f).head<2>());
    const Vec3 off = point - ray.origin;
    EXPECT_LT((off - off.dot(ray.direction) * ray.direction).norm(), 1e-4f);
  }
}

TEST(Camera, PanningMovesTheSceneWithThePointer) {
  const Camera before, after = panned(before, {0.25f, 0});
  EXPECT_NEAR(seen(after, before.target, 1).x(), 0.5f,
              1e-4f);  // a quarter of the height is half of -1..1's half
}

TEST(Camera, ZoomHasLimits) {
  EXPECT_GE(zoomed(Camera(), 0).distance, 0.05f);
  EXPECT_LE(zoomed(Camera(), 1e9f).distance, 500.f);
}

}  // namespace
}  // namespace understudy::render
