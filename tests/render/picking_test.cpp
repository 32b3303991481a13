#include "render/picking.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "render/gizmo.hpp"
#include "tests/render/content.hpp"

namespace understudy::render {
namespace {

constexpr PixelSize kSize{400, 300};

Camera some_camera(bool orthographic = false) {
  Camera camera;
  camera.yaw = 0.7f;
  camera.pitch = 0.4f;
  camera.orthographic = orthographic;
  return camera;
}

Eigen::Vector2f pixel_of(const Camera& camera, const Vec3& point) {
  return on_screen(camera, kSize, point).head<2>();
}

class Picking : public testing::TestWithParam<bool> {
 protected:
  const Camera camera_ = some_camera(GetParam());
};

TEST_P(Picking, APointIsSeenWhereItsRayGoesThrough) {
  const Vec3 point(0.3f, 1.2f, -0.2f);
  const Ray ray = ray_through(camera_, kSize, pixel_of(camera_, point));
  EXPECT_LT((point - ray.origin).cross(ray.direction).norm(), 1e-4f);
  EXPECT_GT((point - ray.origin).dot(ray.direction), 0);
}

TEST_P(Picking, APixelIsAsWideAsSaid) {
  const Vec3 point(0.1f, 1.1f, 0.2f);
  const float step = metres_a_pixel(camera_, kSize, point);
  const Vec3 beside = point + step * axes(camera_).col(0);
  EXPECT_NEAR((pixel_of(camera_, beside) - pixel_of(camera_, point)).norm(), 1, 1e-2f);
}

TEST_P(Picking, FindsEachJointUnderItsPixel) {
  const Joints joints = make_joints();
  for (int j = 0; j < kJointCount; ++j)
    EXPECT_EQ(point_under(joints, camera_, kSize, pixel_of(camera_, joints.row(j)), 3), j) << j;
}

TEST_P(Picking, FindsNothingFurtherThanTheRadius) {
  Points one(1, 3);
  one << 0, 1, 0;
  const Eigen::Vector2f at = pixel_of(camera_, Vec3(0, 1, 0));
  EXPECT_EQ(point_under(one, camera_, kSize, at + Eigen::Vector2f(7, 0), 8), 0);
  EXPECT_EQ(point_under(one, camera_, kSize, at + Eigen::Vector2f(9, 0), 8), std::nullopt);
}

TEST_P(Picking, PrefersTheNearerOfTwoBehindOneAnother) {
  const Vec3 middle(0, 1, 0), back = axes(camera_).col(2);
  Points two(2, 3);
  two.row(0) = middle - 0.5f * back;
  two.row(1) = middle + 0.5f * back;
  const Camera looking = [&] {
    Camera c = camera_;
    c.target = middle;
    return c;
  }();
  EXPECT_EQ(point_under(two, looking, kSize, {200, 150}, 5), 1);
}

TEST_P(Picking, HitsTheFrontOfASurface) {
  const Mesh pear = make_pear();
  Camera camera = camera_;
  camera.target = Vec3(0, 0.6f, 0);
  const Ray ray = ray_through(camera, kSize, Eigen::Vector2f(200, 150));
  const auto hit = surface_under(ray, pear.vertices, pear.faces);
  ASSERT_TRUE(hit);
  EXPECT_GT((hit->position - camera.target).dot(axes(camera).col(2)), 0.1f);
  EXPECT_NEAR(hit->barycentric.sum(), 1, 1e-5f);
  Vec3 mixed = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    mixed += hit->barycentric[k] * pear.vertices.row(pear.faces(hit->face, k)).transpose();
  EXPECT_LT((mixed - hit->position).norm(), 1e-4f);
  EXPECT_LT((pear.vertices.row(hit->vertex).transpose() - hit->position).norm(), 0.08f);
  EXPECT_FALSE(surface_under({ray.origin, -ray.direction}, pear.vertices, pear.faces) && !GetParam());
}

INSTANTIATE_TEST_SUITE_P(Lenses, Picking, testing::Bool(),
                         [](const auto& test) { return test.param ? "Orthographic" : "Perspective"; });

TEST(PickingRay, MissesWhatItPasses) {
  const Mesh pear = make_pear();
  EXPECT_FALSE(surface_under({Vec3(5, 5, 5), Vec3::UnitX()}, pear.vertices, pear.faces));
}

TEST(PickingRay, FindsTheNearestPointBeforeIt) {
  Points points(3, 3);
  points << 0, 0.05f, 2, 0, 0.02f, 5, 0, 0, -1;
  const Ray ray{Vec3::Zero(), Vec3::UnitZ()};
  EXPECT_EQ(point_near(points, ray, 0.1f), 1);
  EXPECT_EQ(point_near(points, ray, 0.01f), std::nullopt);
}

TEST(PickingRay, LeavesOutWhatIsBehindTheEyeOrNotFinite) {
  const Camera camera = some_camera();
  Points points(2, 3);
  points.row(0) = eye(camera) + axes(camera).col(2);
  points.row(1).setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(point_under(points, camera, kSize, {200, 150}, 1000), std::nullopt);
}

class Gizmo : public testing::TestWithParam<bool> {
 protected:
  Gizmo() {
    gizmo_.position = Vec3(0.2f, 1.1f, 0.1f);
    camera_ = some_camera(GetParam());
  }
  Ray through(const Vec3& point) const { return ray_through(camera_, kSize, pixel_of(camera_, point)); }
  /// A place on a handle, in shares of the reach.
  Vec3 at(float x, float y, float z) const {
    return gizmo_.position + gizmo_reach(gizmo_, camera_) * gizmo_.axes * Vec3(x, y, z);
  }
  GizmoView gizmo_;
  Camera camera_;
};

TEST_P(Gizmo, IsAsLargeAsAskedWhereverTheCameraIs) {
  for (const float distance : {1.f, 4.f, 20.f}) {
    camera_.distance = distance;
    const Vec3 up = gizmo_.position + gizmo_reach(gizmo_, camera_) * axes(camera_).col(1);
    EXPECT_NEAR((pixel_of(camera_, up) - pixel_of(camera_, gizmo_.position)).norm(), 0.13f * 300, 0.5f);
  }
}

TEST_P(Gizmo, FindsEachHandle) {
  const auto under = [&](const Vec3& point) { return handle_under(gizmo_, camera_, through(point)); };
  EXPECT_EQ(under(at(0.9f, 0, 0)), GizmoHandle::AxisX);
  EXPECT_EQ(under(at(0, 0.9f, 0)), GizmoHandle::AxisY);
  EXPECT_EQ(under(at(0, 0, 0.9f)), GizmoHandle::AxisZ);
  EXPECT_EQ(under(at(0, 0.4f, 0.4f)), GizmoHandle::PlaneYz);
  EXPECT_EQ(under(at(0.4f, 0, 0.4f)), GizmoHandle::PlaneZx);
  EXPECT_EQ(under(at(0.4f, 0.4f, 0)), GizmoHandle::PlaneXy);
  EXPECT_EQ(under(at(0, 0, 0)), GizmoHandle::Centre);
  EXPECT_EQ(under(gizmo_.position + 2 * gizmo_reach(gizmo_, camera_) * axes(camera_).col(0)),
            GizmoHandle::None);
  gizmo_.kind = GizmoView::Kind::Turn;
  EXPECT_EQ(under(at(0, 0.6f, 0.8f)), GizmoHandle::AxisX);
  EXPECT_EQ(under(at(0.6f, 0, 0.8f)), GizmoHandle::AxisY);
  EXPECT_EQ(under(at(0.6f, 0.8f, 0)), GizmoHandle::AxisZ);
  EXPECT_EQ(under(at(0, 0, 0)), GizmoHandle::None);
  gizmo_.rings = 1;
  EXPECT_EQ(under(at(0, 0.6f, 0.8f)), GizmoHandle::AxisX);
  EXPECT_EQ(under(at(0.6f, 0, 0.8f)), GizmoHandle::None);
}

TEST_P(Gizmo, FollowsThePointerAlongAxesAndPlanes) {
  const auto drag = [&](GizmoHandle handle, const Vec3& by) {
    return dragged(gizmo_, handle, camera_, through(gizmo_.position), through(gizmo_.position + by));
  };
  EXPECT_LT((drag(GizmoHandle::AxisX, {0.2f, 0, 0}) - Vec3(0.2f, 0, 0)).norm(), 1e-3f);
  EXPECT_LT((drag(GizmoHandle::AxisY, {0, -0.1f, 0}) - Vec3(0, -0.1f, 0)).norm(), 1e-3f);
  EXPECT_LT((drag(GizmoHandle::PlaneZx, {0.1f, 0, 0.2f}) - Vec3(0.1f, 0, 0.2f)).norm(), 1e-3f);
  const Vec3 across = 0.1f * axes(camera_).col(0) + 0.2f * axes(camera_).col(1);
  EXPECT_LT((drag(GizmoHandle::Centre, across) - across).norm(), 1e-3f);
  EXPECT_TRUE(drag(GizmoHandle::None, across).isZero());
  EXPECT_NEAR(drag(GizmoHandle::AxisX, across).tail<2>().norm(), 0, 1e-6f);
}

TEST_P(Gizmo, TurnsAsThePointerGoesRound) {
  gizmo_.kind = GizmoView::Kind::Turn;
  const Ray from = through(at(1, 0, 0));
  const Ray to = through(at(std::cos(0.5f), std::sin(0.5f), 0));
  EXPECT_NEAR(turned(gizmo_, GizmoHandle::AxisZ, camera_, from, to), 0.5f, 1e-3f);
  EXPECT_NEAR(turned(gizmo_, GizmoHandle::AxisZ, camera_, to, from), -0.5f, 1e-3f);
  EXPECT_EQ(turned(gizmo_, GizmoHandle::Centre, camera_, from, to), 0);
}

TEST_P(Gizmo, TurnsWhenItsRingIsSeenFromTheEdge) {
  gizmo_.kind = GizmoView::Kind::Turn;
  camera_.yaw = 0;
  camera_.pitch = 0;
  camera_.target = gizmo_.position;
  const Ray from = through(gizmo_.position), to = through(gizmo_.position + Vec3(0.05f, 0, 0));
  // The ring's front, towards the eye (+z), goes to +x: right-handed about +y.
  EXPECT_GT(turned(gizmo_, GizmoHandle::AxisY, camera_, from, to), 0.01f);
}

INSTANTIATE_TEST_SUITE_P(Lenses, Gizmo, testing::Bool(),
                         [](const auto& test) { return test.param ? "Orthographic" : "Perspective"; });

}  // namespace
}  // namespace understudy::render
