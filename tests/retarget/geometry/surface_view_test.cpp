#include "retarget/geometry/surface_view.hpp"

#include <gtest/gtest.h>

namespace understudy {
namespace {

/// A square with its middle at a place, across the z axis.
Points square_at(const Vec3& middle, float half) {
  Points points(4, 3);
  points << -half, -half, 0, half, -half, 0, half, half, 0, -half, half, 0;
  points.rowwise() += middle.transpose();
  return points;
}

Faces two_triangles() {
  Faces faces(2, 3);
  faces << 0, 1, 2, 0, 2, 3;
  return faces;
}

Pinhole front_camera(bool orthographic) {
  Pinhole camera = looking_at(Vec3::Zero(), camera_axes(0, 0), 4);
  camera.focal = orthographic ? 25.0f : 100.0f;
  camera.centre = {31.5f, 23.5f};
  camera.orthographic = orthographic;
  return camera;
}

TEST(SurfaceView, SeesTheNearestSurfaceAtItsDepth) {
  for (const bool orthographic : {false, true}) {
    Points vertices(8, 3);
    vertices << square_at(Vec3::Zero(), 0.5f), square_at(Vec3(0, 0, 1), 0.1f);
    Faces faces(4, 3);
    faces << two_triangles(), (two_triangles().array() + 4).matrix();
    const SurfaceView view = surface_view(front_camera(orthographic), 64, 48, vertices, faces);
    EXPECT_NEAR(view.depth[view.at(32, 24)], 3, 1e-4f);
    EXPECT_GE(view.face[view.at(32, 24)], 2);
    EXPECT_NEAR(view.depth[view.at(40, 24)], 4, 1e-4f);
    EXPECT_EQ(view.face[view.at(1, 1)], -1);
    EXPECT_EQ(view.depth[view.at(1, 1)], SurfaceView::kNothing);
  }
}

TEST(SurfaceView, ATiltedSurfaceIsAsDeepAsTheRayIsLong) {
  Points vertices(3, 3);
  vertices << -2, -2, 1, 2, -2, 1, 0, 3, -2;
  Faces faces(1, 3);
  faces << 0, 1, 2;
  const Pinhole camera = front_camera(false);
  const SurfaceView view = surface_view(camera, 64, 48, vertices, faces);
  for (const auto& [x, y] : {std::pair{20, 30}, std::pair{32, 20}, std::pair{45, 40}}) {
    const size_t at = view.at(x, y);
    ASSERT_EQ(view.face[at], 0);
    const Vec3 place = camera.unproject({static_cast<float>(x), static_cast<float>(y)}, view.depth[at]);
    EXPECT_LT((vertices.transpose() * view.shares[at] - place).norm(), 1e-4f);
  }
}

TEST(SurfaceView, LeavesOutWhatReachesBehindTheEye) {
  const SurfaceView view =
      surface_view(front_camera(false), 64, 48, square_at(Vec3(0, 0, 5), 1), two_triangles());
  EXPECT_EQ(*std::max_element(view.face.begin(), view.face.end()), -1);
}

}  // namespace
}  // namespace understudy
