#include "render/pose_picture.hpp"

#include <gtest/gtest.h>

#include <set>

#include "render/surface_pictures.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::render {
namespace {

namespace b25 = body25;
using Rgb = std::array<int, 3>;

Rgb pixel(const Image& image, int x, int y) {
  const uint8_t* at = image.at(x, y);
  return {at[0], at[1], at[2]};
}

std::set<Rgb> colours_of(const Image& image) {
  std::set<Rgb> colours;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) colours.insert(pixel(image, x, y));
  return colours;
}

/// Far apart from one another, so that no stick covers another.
FlatPose star(const Canvas& canvas) {
  FlatPose pose;
  for (int point = 0; point < kBodyPoints; ++point) {
    const float angle = 2 * kPi * static_cast<float>(point * 7 % kBodyPoints) / kBodyPoints;
    const Vec2 out(std::cos(angle), std::sin(angle));
    const float reach = 0.4f * static_cast<float>(std::min(canvas.width, canvas.height));
    pose.set(point, Vec2(canvas.width / 2, canvas.height / 2) + reach * out, 1);
  }
  return pose;
}

TEST(PosePicture, APngHasTheExactColoursOfEveryStickAndDisc) {
  const test::TempFolder folder;
  for (const PoseLayout layout : {PoseLayout::OpenPose18, PoseLayout::Body25}) {
    PosePictureOptions options;
    options.layout = layout;
    const Canvas canvas{640, 512};
    write_png(folder.path("a.png"), pose_picture({star(canvas)}, canvas, options));
    const std::set<Rgb> colours = colours_of(read_png(folder.path("a.png")));
    std::set<Rgb> known = {{0, 0, 0}};
    for (const PoseStick& stick : pose_sticks(layout))
      known.insert({dimmed(stick.rgb[0]), dimmed(stick.rgb[1]), dimmed(stick.rgb[2])});
    for (const PoseDisc& disc : pose_discs(layout)) known.insert({disc.rgb[0], disc.rgb[1], disc.rgb[2]});
    EXPECT_EQ(colours, known);
  }
}

TEST(PosePicture, HasTheColoursThatControlNetKnows) {
  const auto& sticks = pose_sticks(PoseLayout::OpenPose18);
  const auto& discs = pose_discs(PoseLayout::OpenPose18);
  ASSERT_EQ(sticks.size(), 17u);
  ASSERT_EQ(discs.size(), 18u);
  FlatPose pose;
  pose.set(b25::Neck, {20, 20}, 1), pose.set(b25::RightShoulder, {80, 20}, 1);
  const Image image = pose_picture({pose}, {100, 40});
  EXPECT_EQ(pixel(image, 50, 20), (Rgb{153, 0, 0}));
  EXPECT_EQ(pixel(image, 20, 20), (Rgb{255, 85, 0}));
  EXPECT_EQ(pixel(image, 80, 20), (Rgb{255, 170, 0}));
  EXPECT_EQ(pixel(image, 50, 24), (Rgb{153, 0, 0}));
  EXPECT_EQ(pixel(image, 50, 25), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(image, 80, 24), (Rgb{255, 170, 0}));
  EXPECT_EQ(pixel(image, 84, 21), (Rgb{0, 0, 0}));
}

TEST(PosePicture, LeavesOutSticksWithAMissingEnd) {
  FlatPose pose;
  pose.set(b25::Neck, {20, 20}, 1), pose.set(b25::RightElbow, {80, 20}, 1);
  EXPECT_EQ(pixel(pose_picture({pose}, {100, 40}), 50, 20), (Rgb{0, 0, 0}));
}

TEST(PosePicture, SticksAreWiderOnLargerCanvases) {
  EXPECT_FLOAT_EQ(usual_half_width({480, 832}), 4);
  EXPECT_FLOAT_EQ(usual_half_width({1024, 1024}), 8);
  EXPECT_EQ(wide_stick_factor({480, 480}), 1);
  EXPECT_EQ(wide_stick_factor({832, 480}), 2);
  EXPECT_EQ(wide_stick_factor({1024, 1024}), 3);
  EXPECT_EQ(wide_stick_factor({9000, 1024}), 7);
  FlatPose pose;
  pose.set(b25::Neck, {20, 100}, 1), pose.set(b25::RightShoulder, {480, 100}, 1);
  PosePictureOptions wide;
  wide.wide_sticks = true;
  const Image image = pose_picture({pose}, {512, 200}, wide);
  EXPECT_EQ(pixel(image, 250, 107), (Rgb{153, 0, 0}));
  EXPECT_EQ(pixel(image, 20, 105), (Rgb{0, 0, 0}));
  PosePictureOptions chosen;
  chosen.half_width = 10;
  EXPECT_EQ(pixel(pose_picture({pose}, {512, 200}, chosen), 250, 109), (Rgb{153, 0, 0}));
}

TEST(PosePicture, DrawsHandsInHuesAndTheFaceInWhite) {
  FlatPose pose;
  pose.left_hand = FlatPoints::Zero(kHandPoints, 3);
  for (int k = 0; k < kHandPoints; ++k)
    pose.left_hand.row(k) << 20.0f + 40 * static_cast<float>(k % 5), 20.0f + 30 * static_cast<float>(k / 5),
        1;
  pose.face = FlatPoints::Zero(kFacePoints, 3);
  pose.face.row(0) << 250, 50, 1;
  const Image image = pose_picture({pose}, {300, 200});
  EXPECT_EQ(pixel(image, 20, 20), (Rgb{0, 0, 255}));
  EXPECT_EQ(pixel(image, 40, 20), (Rgb{255, 0, 0}));  // the wrist's first line is red
  EXPECT_EQ(pixel(image, 253, 50), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel(image, 254, 50), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(image, 0, 0), (Rgb{0, 0, 0}));
  PosePictureOptions bare;
  bare.hands = bare.face = false;
  EXPECT_EQ(colours_of(pose_picture({pose}, {300, 200}, bare)).size(), 1u);
}

TEST(PosePicture, EndsAtTheEdgesOfAnOddCanvas) {
  FlatPose pose;
  pose.set(b25::Neck, {-50, 30}, 1), pose.set(b25::RightShoulder, {400, 31}, 1);
  pose.set(b25::Nose, {1e9f, -1e9f}, 1);
  const Image image = pose_picture({pose}, {333, 61});
  EXPECT_EQ(image.width, 333);
  EXPECT_EQ(pixel(image, 332, 30), (Rgb{153, 0, 0}));
  EXPECT_TRUE(test::contains(test::error_of([] { pose_picture({}, {0, 5}); }), "0 x 5"));
}

TEST(PngFile, SaysItsCommentAtItsBeginningAndIsStillAPicture) {
  const test::TempFolder folder;
  const Image image = pose_picture({star({99, 77})}, {99, 77});
  const std::string bytes = png_file(image, "made here");
  EXPECT_LT(bytes.find("made here"), 60u);
  EXPECT_EQ(read_png(folder.write("a.png", bytes)).pixels, image.pixels);
}

TEST(SurfacePictures, NearIsWhiteAndTowardsTheViewerIsBlue) {
  Points vertices(3, 3);
  vertices << -1, -1, 0, 1, -1, 0, 0, 1, 0;
  Faces faces(1, 3);
  faces << 0, 1, 2;
  Pinhole camera = looking_at(Vec3::Zero(), camera_axes(0, 0), 4);
  camera.focal = 60, camera.centre = {31.5f, 31.5f};
  const SurfaceView view = surface_view(camera, 64, 64, vertices, faces);
  EXPECT_EQ(pixel(depth_picture(view, {4, 8}), 32, 32), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel(depth_picture(view, {1, 4}), 32, 32), (Rgb{48, 48, 48}));
  EXPECT_EQ(pixel(depth_picture(view, {1, 4}), 0, 0), (Rgb{0, 0, 0}));
  Points normals(3, 3);
  normals << 0, 0, 1, 0, 0, 1, 0, 0, 1;
  EXPECT_EQ(pixel(normal_picture(view, camera, faces, normals), 32, 32), (Rgb{128, 128, 255}));
  EXPECT_EQ(colours_of(mask_picture(view)), (std::set<Rgb>{{0, 0, 0}, {255, 255, 255}}));
}

}  // namespace
}  // namespace understudy::render
