// Pose pictures of a performed motion: where points lie, what is written beside, what is refused.
#include "app/run/pose_pictures.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>

#include "render/video_reader.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::TempFolder;

constexpr int kFrames = 13;
constexpr double kFps = 24;

ExportInput filmed_input() {
  const auto character =
      std::make_shared<PreparedCharacter>(prepare_character(tests::make_character(), nullptr, nullptr));
  ExportInput input;
  input.body.character = character;
  input.body.screen = std::make_shared<RigDeformer>(*character, nullptr);
  input.clips = {{"walk", kFps, tests::made_motion(kFrames, character->target.joints)}};
  return input;
}

ExportCost film(const std::string& path, const ExportInput& input) {
  return export_motion(path, export_format("poses", path), {input});
}

KeypointReading filmed_poses(const std::string& path) {
  return read_keypoints(path);
}

/// Where a camera at `eye` that looks at `target` sees a point, with a vertical lens and the picture's axis
/// in the middle; written anew, in doubles, by the textbook (Hartley and Zisserman, 2004, section 6.1).
Eigen::Vector2d seen_by_the_book(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double fov_deg,
                                 const Canvas& canvas, const Eigen::Vector3d& point) {
  const Eigen::Vector3d ahead = (target - eye).normalized();
  const Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitY()).normalized();
  Eigen::Matrix3d R;
  R << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();  // x right, y down, z ahead
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = K(1, 1) = canvas.height / 2.0 / std::tan(fov_deg * M_PI / 360);
  K(0, 2) = (canvas.width - 1) / 2.0, K(1, 2) = (canvas.height - 1) / 2.0;
  return (K * R * (point - eye)).hnormalized();
}

TEST(PosePictures, PointsLieWhereAnIndependentProjectionPutsThem) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  input.body.poses.camera = picture_camera("yaw=35,pitch=12,distance=4.5,fov=40");
  input.body.poses.camera.target = Vec3(0.1f, 0.9f, 0);
  input.body.poses.canvas = Canvas{641, 479};
  input.body.poses.file = PoseFile::OpenPose;
  film(folder.path("control"), input);
  const KeypointReading read = filmed_poses(folder.path("control_openpose"));
  ASSERT_EQ(read.frames.size(), size_t{kFrames});
  const double yaw = 35 * M_PI / 180, pitch = 12 * M_PI / 180;
  const Eigen::Vector3d target(0.1, 0.9, 0);
  const Eigen::Vector3d eye = target + 4.5 * Eigen::Vector3d(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                                                             std::cos(yaw) * std::cos(pitch));
  double farthest = 0;
  int compared = 0;
  for (int t = 0; t < kFrames; ++t) {
    const Pose& pose = input.clips[0].poses[static_cast<size_t>(t)];
    const Joints joints = forward_kinematics(input.body.character->target.joints, pose).joints;
    const FlatPose* const flat = read.performing().at(t);
    ASSERT_NE(flat, nullptr);
    for (const int point : {2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14}) {  // joints as they are
      if (!flat->has(point)) continue;
      const Eigen::Vector3d place = joints.row(kJointOfPoint[static_cast<size_t>(point)]).cast<double>();
      const Eigen::Vector2d want = seen_by_the_book(eye, target, 40, {641, 479}, place);
      farthest = std::max(farthest, (flat->at(point).cast<double>() - want).norm());
      ++compared;
    }
  }
  EXPECT_GT(compared, 10 * kFrames);
  EXPECT_LT(farthest, 0.05);
  RecordProperty("farthest_px", std::to_string(farthest));
  std::printf("farthest off an independent projection: %.5f px of %d points\n", farthest, compared);
}

TEST(PosePictures, AMarkThatWasMovedIsSeenThere) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  input.body.poses.hides_face = false;
  film(folder.path("found.json"), input);
  const Joints& rest = input.body.character->target.joints;
  const Vec3 moved = rest.row(Head).transpose() + Vec3(0.3f, 0.1f, 0);
  input.body.face = {{FaceMark::LeftEar, moved}};
  film(folder.path("moved.json"), input);
  const KeypointReading found = filmed_poses(folder.path("found.json")),
                        after = filmed_poses(folder.path("moved.json"));
  const FlatPose &before = *found.performing().at(0), &now = *after.performing().at(0);
  EXPECT_GT((now.at(body25::LeftEar) - before.at(body25::LeftEar)).norm(), 5);
  EXPECT_EQ(now.at(body25::RightEar), before.at(body25::RightEar));
}

TEST(PosePictures, ByDefaultHoldTheWholeTakeFromTheFront) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  for (size_t t = 0; t < input.clips[0].poses.size(); ++t)
    input.clips[0].poses[t].root.x() += 0.2f * static_cast<float>(t);
  input.body.poses.file = PoseFile::OpenPose;
  input.body.poses.hides_face = false;
  film(folder.path("control"), input);
  const KeypointReading read = filmed_poses(folder.path("control_openpose"));
  float left = 1e9f, right = 0;
  for (int t = 0; t < kFrames; ++t) {
    ASSERT_EQ(points_seen(*read.performing().at(t)), kBodyPoints) << t;
    left = std::min(left, box_of(*read.performing().at(t)).min().x());
    right = std::max(right, box_of(*read.performing().at(t)).max().x());
  }
  EXPECT_GT(left, 20);
  EXPECT_LT(right, 812);
  EXPECT_GT(right - left, 500);
  const render::Image first = render::read_png(folder.path("control/frame_00000.png"));
  EXPECT_EQ(first.width, 832);
  EXPECT_EQ(first.height, 480);
}

TEST(PosePictures, RateAndCountAreAsGeneratorsWant) {
  const TempFolder folder;
  ExportInput input = filmed_input();  // half a second
  input.body.poses.rate = 16;
  EXPECT_EQ(film(folder.path("a"), input).frames, 9);
  input.body.poses.rate = 20;  // 11 pictures
  input.body.poses.count = picture_count("4n+1");
  EXPECT_EQ(film(folder.path("b"), input).frames, 9);
  input.body.poses.count = picture_count("17");
  EXPECT_EQ(film(folder.path("c"), input).frames, 17);
  const KeypointReading read = filmed_poses(folder.path("c.json"));
  EXPECT_EQ(*read.performing().at(16), *read.performing().at(12));
  EXPECT_NE(*read.performing().at(5), *read.performing().at(4));
}

TEST(PosePictures, AFilmOfAnOddCanvasComesWithItsList) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  input.body.poses.canvas = Canvas{321, 241};
  EXPECT_EQ(film(folder.path("control.mp4"), input).frames, kFrames);
  EXPECT_EQ(filmed_poses(folder.path("control.json")).canvas, (Canvas{321, 241}));
  render::VideoReader video(folder.path("control.mp4"));
  int pictures = 0;
  while (video.next()) ++pictures;
  EXPECT_EQ(pictures, kFrames);
}

TEST(PosePictures, ThePoseListAloneHasNoPictures) {
  const TempFolder folder;
  const ExportInput input = filmed_input();
  export_motion(folder.path("out.json"), export_format("", folder.path("out.json")), {input});
  EXPECT_EQ(filmed_poses(folder.path("out.json")).frames.size(), size_t{kFrames});
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 1);
}

TEST(PosePictures, DepthNormalsAndMaskShowTheSameView) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  input.body.poses.canvas = Canvas{256, 256};
  input.body.poses.depth = input.body.poses.normals = input.body.poses.mask = true;
  film(folder.path("control"), input);
  const render::Image mask = render::read_png(folder.path("control_mask/frame_00003.png"));
  const render::Image depth = render::read_png(folder.path("control_depth/frame_00003.png"));
  const KeypointReading read = filmed_poses(folder.path("control.json"));
  const Vec2 hip = read.performing().at(3)->at(body25::RightKnee);
  const int x = static_cast<int>(std::lround(hip.x())), y = static_cast<int>(std::lround(hip.y()));
  EXPECT_EQ(mask.at(x, y)[0], 255);
  EXPECT_GT(depth.at(x, y)[0], 47);
  for (size_t i = 0; i < mask.pixels.size(); ++i) ASSERT_EQ(mask.pixels[i] > 0, depth.pixels[i] > 0);
  EXPECT_TRUE(fs::exists(folder.path("control_normals/frame_00012.png")));
}

TEST(PosePictures, TheReferencesCameraLaysTheFirstFrameOntoIt) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  input.body.poses.camera = picture_camera("yaw=-50,distance=6,fov=30");
  input.body.poses.camera.target = Vec3(0.4f, 1, 0.2f);
  input.body.poses.canvas = Canvas{480, 832};
  film(folder.path("reference.json"), input);
  const KeypointReading reference = filmed_poses(folder.path("reference.json"));
  input.body.poses.camera = picture_camera(folder.path("reference.json"));
  input.body.poses.canvas.reset();
  film(folder.path("again.json"), input);
  const KeypointReading again = filmed_poses(folder.path("again.json"));
  EXPECT_EQ(again.canvas, reference.canvas);
  const FlatPose &want = *reference.performing().at(0), &got = *again.performing().at(0);
  for (int point = 0; point < 8; ++point)
    if (want.has(point) && got.has(point)) EXPECT_LT((want.at(point) - got.at(point)).norm(), 3) << point;
}

TEST(PosePictures, RefuseWhatCannotBeInASentence) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  const auto refused = [&](auto change) {
    ExportInput changed = input;
    change(changed.body.poses);
    return error_of([&] { film(folder.path("control"), changed); });
  };
  EXPECT_TRUE(contains(refused([](PoseChoice& c) { c.canvas = Canvas{0, 480}; }), "sides of 1 to 16384"));
  EXPECT_TRUE(contains(refused([](PoseChoice& c) { c.rate = 5000; }), "1 to 1000 a second"));
  EXPECT_TRUE(
      contains(refused([](PoseChoice& c) { c.camera.distance_m = 2, c.camera.target = Vec3(50, 0, 0); }),
               "nobody is in the camera's view"));
  EXPECT_TRUE(contains(refused([](PoseChoice& c) { c.camera.reference = "none.json"; }), "none.json"));
  export_motion(folder.path("control.json"), export_format("pose_list", ""), {input});
  EXPECT_TRUE(contains(refused([&](PoseChoice& c) { c.camera.reference = folder.path("control.json"); }),
                       "would be lost"));
  fs::remove(folder.path("control.json"));
  EXPECT_FALSE(fs::exists(folder.path("control")));
  EXPECT_FALSE(fs::exists(folder.path("control.json")));
  folder.write("mine/note.txt", "keep me");
  EXPECT_TRUE(contains(error_of([&] { film(folder.path("mine"), input); }), "choose another folder"));
}

TEST(PosePictures, AreNotChosenForAFileWithoutPictures) {
  const TempFolder folder;
  ExportInput input = filmed_input();
  EXPECT_TRUE(is_usual(input.body.poses));
  input.body.poses.mask = true;
  for (const char* name : {"a.bvh", "a.glb"})
    EXPECT_TRUE(contains(
        error_of([&] { export_motion(folder.path(name), export_format("", name), {input}); }), "no pictures"))
        << name;
}

TEST(PictureCamera, IsWordsOrAFile) {
  const PictureCamera words = picture_camera("yaw=-30.5,fov=40,orthographic");
  EXPECT_FLOAT_EQ(*words.yaw_deg, -30.5f);
  EXPECT_FLOAT_EQ(*words.fov_deg, 40);
  EXPECT_FALSE(words.distance_m);
  EXPECT_TRUE(words.orthographic);
  const TempFolder folder;
  const PictureCamera file =
      picture_camera(folder.write("c.json", R"({"yaw_deg": 20, "distance_m": 3, "target": [0, 1, 0.5]})"));
  EXPECT_FLOAT_EQ(*file.yaw_deg, 20);
  EXPECT_EQ(*file.target, Vec3(0, 1, 0.5f));
}

TEST(PictureCamera, BadOnesAreNamed) {
  const TempFolder folder;
  const auto of = [&](const std::string& words) { return error_of([&] { picture_camera(words); }); };
  EXPECT_TRUE(contains(of(folder.path("none.json")), "none.json"));
  EXPECT_TRUE(contains(of("front"), "'front' is neither"));
  EXPECT_TRUE(contains(of("yaw=left"), "is no number"));
  EXPECT_TRUE(contains(of("yaw=1,zoom=2"), "has no 'zoom'"));
  EXPECT_TRUE(contains(of("fov=0"), "between 1 and 150"));
  EXPECT_TRUE(contains(of(folder.write("a.json", "[]")), "neither a camera nor"));
  EXPECT_TRUE(contains(of(folder.write("b.json", "{\"yaw_deg\": \"left\"}")), "yaw_deg is no number"));
  EXPECT_TRUE(contains(of(folder.write("d.json", "{\"target\": [1]}")), "three numbers"));
}

TEST(PictureCount, IsANumberOr4nPlus1) {
  EXPECT_EQ(picture_count("81").count, 81);
  EXPECT_TRUE(picture_count("4n+1").is_4n_plus_1);
  for (const char* bad : {"0", "-3", "many", "4.5", ""})
    EXPECT_TRUE(contains(error_of([&] { picture_count(bad); }), "--count")) << bad;
}

}  // namespace
}  // namespace understudy::app
