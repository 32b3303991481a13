#include "retarget/geometry/pinhole.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace understudy {
namespace {

Pinhole some_camera(bool orthographic) {
  Pinhole camera = looking_at(Vec3(0.2f, 1, -0.1f), camera_axes(0.7f, 0.3f), 4);
  camera.focal = orthographic ? 200.0f : 900.0f;
  camera.centre = {320, 240};
  camera.orthographic = orthographic;
  return camera;
}

TEST(Pinhole, SeesWhatItLooksAtInTheCentre) {
  for (const bool orthographic : {false, true}) {
    const Vec3 seen = some_camera(orthographic).project(Vec3(0.2f, 1, -0.1f));
    EXPECT_LT((seen - Vec3(320, 240, 4)).norm(), 1e-3f);
  }
}

TEST(Pinhole, PutsTheLeftOfWhoFacesItOnTheRightAndWhatIsHigherHigher) {
  Pinhole camera = looking_at(Vec3::Zero(), camera_axes(0, 0), 5);
  camera.focal = 1000;
  EXPECT_LT((camera.project(Vec3(1, 0, 0)) - Vec3(200, 0, 5)).norm(), 1e-3f);   // +x is the left hand's side
  EXPECT_LT((camera.project(Vec3(0, 1, 0)) - Vec3(0, -200, 5)).norm(), 1e-3f);  // y goes down
  EXPECT_LT((camera.project(Vec3(1, 0, 1)) - Vec3(250, 0, 4)).norm(), 1e-3f);   // nearer, so larger
  camera.orthographic = true;
  EXPECT_LT((camera.project(Vec3(1, 0, 1)) - Vec3(1000, 0, 4)).norm(), 1e-3f);  // not so here
}

TEST(Pinhole, LooksFromTheLeftAtNinetyDegreesAndDownFromAbove) {
  EXPECT_LT((looking_at(Vec3::Zero(), camera_axes(kPi / 2, 0), 3).position - Vec3(3, 0, 0)).norm(), 1e-5f);
  EXPECT_GT(looking_at(Vec3::Zero(), camera_axes(0, 0.4f), 3).position.y(), 1);
  EXPECT_NEAR(camera_axes(1.2f, -0.4f).determinant(), 1, 1e-5f);
}

TEST(Pinhole, BringsBackWhatItProjects) {
  for (const bool orthographic : {false, true}) {
    const Pinhole camera = some_camera(orthographic);
    const Vec3 point(-0.4f, 1.6f, 0.5f), seen = camera.project(point);
    EXPECT_LT((camera.unproject(seen.head<2>(), seen.z()) - point).norm(), 1e-5f);
  }
}

TEST(Pinhole, ShowsAMetreAcrossTheViewAsManyPixels) {
  for (const bool orthographic : {false, true}) {
    const Pinhole camera = some_camera(orthographic);
    const Vec3 point(0.1f, 0.4f, 0.3f), beside = point + camera.rotation.col(0);
    const Points seen = camera.project((Points(2, 3) << point.transpose(), beside.transpose()).finished());
    EXPECT_NEAR((seen.row(1) - seen.row(0)).norm(), camera.pixels_a_metre(seen(0, 2)), 1e-3f);
  }
}

}  // namespace
}  // namespace understudy
