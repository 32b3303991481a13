// Wireframes, and clouds that are seen through: what they show and what they hide.
#include <gtest/gtest.h>

#include "tests/render/content.hpp"
#include "tests/render/pictures.hpp"

namespace understudy::render {
namespace {

constexpr PixelSize kSize{160, 160};

/// A square of two triangles that faces the camera, `z` metres before the origin.
MeshView square(float z, float half = 0.8f) {
  MeshView view;
  Points vertices(4, 3);
  vertices << -half, -half, z, half, -half, z, half, half, z, -half, half, z;
  Faces faces(2, 3);
  faces << 0, 1, 2, 0, 2, 3;
  view.vertices = vertices, view.faces = faces;
  view.color = Vec3(0.8f, 0.8f, 0.8f);
  return view;
}

/// The same square as a cloud without holes, each point at a depth of its own as those of a scan are.
PointsView cloud(float z, const Vec3& color, float opacity) {
  constexpr int kSide = 60;
  Points points(kSide * kSide, 3);
  for (int i = 0; i < kSide * kSide; ++i)
    points.row(i) << 1.6f * static_cast<float>(i % kSide) / kSide - 0.8f,
        1.6f * static_cast<float>(i / kSide) / kSide - 0.8f, z + 1e-5f * static_cast<float>(i);
  PointsView view;
  view.positions = points;
  view.normals = Points(Eigen::RowVector3f(0, 0, 1).replicate(points.rows(), 1));
  view.radius = 0.03f, view.color = color, view.opacity = opacity;
  return view;
}

Camera straight() {
  Camera camera;
  camera.target = Vec3::Zero(), camera.yaw = camera.pitch = 0;
  return camera;
}

Image drawn(const Scene& scene) {
  Scene plain = scene;
  plain.ground.visible = false;
  return picture(plain, straight(), kSize);
}

int brightness(const Image& image, int x, int y) {
  const uint8_t* at = image.at(x, y);
  return at[0] + at[1] + at[2];
}

/// How many pixels are darker by more than a tenth.
int darker(const Image& with, const Image& without) {
  int count = 0;
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x)
      count += brightness(with, x, y) < 0.9f * brightness(without, x, y) ? 1 : 0;
  return count;
}

TEST(Wireframe, DrawsTheEdgesOfFacesAndNothingBetween) {
  Scene plain, wired;
  plain.meshes = {square(0)};
  wired.meshes = {square(0)};
  wired.meshes[0].wireframe = true;
  const Image with = drawn(wired), without = drawn(plain);
  const int side = 125;  // pixels
  EXPECT_GT(darker(with, without), 4 * side) << "a diagonal and four sides";
  EXPECT_LT(darker(with, without), 16 * side);
  EXPECT_LT(brightness(with, 80, 80), 0.9f * brightness(without, 80, 80))
      << "the diagonal goes through the middle";
  EXPECT_EQ(brightness(with, 95, 70), brightness(without, 95, 70));
}

TEST(Wireframe, HidesTheEdgesBehind) {
  Scene plain, wired;
  plain.meshes = {square(0.3f), square(-0.3f, 0.4f)};
  wired = plain;
  wired.meshes[1].wireframe = true;
  EXPECT_EQ(darker(drawn(wired), drawn(plain)), 0);
}

TEST(SeeThroughCloud, LetsWhatIsBehindItThroughByItsOpacity) {
  const Vec3 red(0.9f, 0.1f, 0.1f);
  const auto red_of = [&](float opacity) {
    Scene scene;
    scene.meshes = {square(-0.3f)};
    scene.clouds = {cloud(0.3f, red, opacity)};
    const Image image = drawn(scene);
    return image.at(70, 90)[0] - image.at(70, 90)[1];
  };
  const int none = red_of(0.01f), some = red_of(0.5f), all = red_of(1);
  EXPECT_LT(none, 20);
  EXPECT_GT(all, 100);
  EXPECT_NEAR(some, (none + all) / 2, 30);
}

TEST(SeeThroughCloud, HidesNothingThatIsDrawnAfterIt) {
  Scene scene;
  scene.meshes = {square(-0.3f)};
  scene.meshes[0].opacity = 0.6f, scene.meshes[0].color = Vec3(0.1f, 0.9f, 0.1f);
  Scene both = scene;
  both.clouds = {cloud(0.3f, Vec3(0.9f, 0.1f, 0.1f), 0.3f)};
  const Image image = drawn(both);
  EXPECT_GT(image.at(70, 90)[1], image.at(70, 90)[0]) << "the green behind is seen through the red";
}

/// A thick red bone across the middle.
SkeletonView bone(float z, float opacity) {
  SkeletonView view;
  view.joints.resize(2, 3);
  view.joints << -0.5f, 0, z, 0.5f, 0, z;
  view.parents = {-1, 0};
  view.tint = Vec3(0.9f, 0.1f, 0.1f), view.tint_share = 1;
  view.thickness = 6, view.x_ray = false, view.opacity = opacity;
  return view;
}

TEST(SeeThroughSkeleton, IsSeenInsideASeeThroughBodyAndMakesNoHoleInOneBehind) {
  Scene scene;
  scene.meshes = {square(-0.3f)};
  scene.meshes[0].opacity = 0.6f, scene.meshes[0].color = Vec3(0.1f, 0.9f, 0.1f);
  const Image without = drawn(scene);
  scene.skeletons = {bone(0.3f, 0.3f)};
  const Image before = drawn(scene);
  EXPECT_GT(before.at(80, 80)[1], before.at(80, 80)[0]) << "the green behind is seen through the red";
  scene.skeletons = {bone(-0.6f, 0.8f)};
  EXPECT_GT(darker(drawn(scene), without), 60) << "the bone is seen through the green";
}

}  // namespace
}  // namespace understudy::render
