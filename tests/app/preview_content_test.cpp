// What the file browser shows beside a file.
#include "app/studio/preview_content.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/app/sample_files.hpp"
#include "tests/retarget/motion/made_motion.hpp"
#include "tests/support/flat_track.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

class Preview : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("understudy_preview_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static Vec3 size_of(const Mesh& mesh) {
    return (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).transpose();
  }

  fs::path folder_;
};

TEST_F(Preview, OfAMotionIsItsSkeletonWithClipsAndSeconds) {
  std::vector<Pose> poses(121);
  for (size_t i = 0; i < poses.size(); ++i) poses[i].root = Vec3(0, 0.95f, 0.01f * static_cast<float>(i));
  std::ofstream(path("walk.bvh")) << tests::made_bvh({}, tests::made_joints({}), poses);
  const PreviewContent content = preview_content(path("walk.bvh"));
  ASSERT_TRUE(content.joints) << content.text;
  EXPECT_EQ(content.mesh.vertices.rows(), 0);
  EXPECT_NEAR(content.joints->col(1).minCoeff(), 0, 1e-4f);
  EXPECT_GT((*content.joints)(Head, 1), 1.2f);
  EXPECT_EQ(content.text.substr(0, 13), "1 clip, 1.0 s") << content.text;
}

TEST_F(Preview, OfALyingCharacterShowsItStanding) {
  tests::MadeCharacter bare;
  bare.rigged = false;
  Character lying = tests::make_character(bare);
  const Mat3 onto_the_back = rotation_from_axis_angle({-kPi / 2, 0, 0});
  for (auto& part : lying.parts) {
    part.vertices = (part.vertices * onto_the_back.transpose()).eval();
    part.normals = (part.normals * onto_the_back.transpose()).eval();
  }
  ASSERT_LT(size_of(merged_surface(lying, bind_pose(lying).vertices).mesh).y(), 0.8f);
  write_gltf_character(path("lying.glb"), lying);
  const PreviewContent content = preview_content(path("lying.glb"));
  EXPECT_GT(size_of(content.mesh).y(), 1.4f) << content.text;
  EXPECT_LT(size_of(content.mesh).z(), 0.8f);
}

TEST_F(Preview, OfAFolderWithoutScansNamesNoneOfItsFiles) {
  tests::write_text(path("diary.txt"), "Dear diary");
  tests::write_text(path("secret.ply"), "not a PLY");
  const PreviewContent content = preview_content(folder_.string());
  EXPECT_EQ(content.text, "No frames of a scan in this folder.");
  EXPECT_EQ(content.mesh.vertices.rows(), 0);
}

TEST_F(Preview, OfPosesSaysWhatTheyAre) {
  write_openpose_folder(path("poses"), walking_track(12, 6, 2));
  EXPECT_EQ(preview_content(path("poses")).text, "OpenPose folder, BODY_25, 12 frames, 2 people");
  write_controlnet(path("tall.json"), standing_track(1));
  EXPECT_TRUE(ends_with(preview_content(path("tall.json")).text, "1 frame, 1 person, 640 x 560"));
}

TEST_F(Preview, OfScansIsTheFirstFrame) {
  tests::write_scans(path("scans"), 3);
  const PreviewContent content = preview_content(path("scans"));
  EXPECT_EQ(content.text, "3 frames, 2,500 points");
  EXPECT_FALSE(content.joints);
}

}  // namespace
}  // namespace understudy::app
