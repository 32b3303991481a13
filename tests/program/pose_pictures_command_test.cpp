// Pose pictures by the shipped program: `retarget --out control.mp4`, `export --format poses`, bad input.
#include "render/image.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

class PosePicturesCommand : public ShippedProgram {
 protected:
  Finished film(std::vector<std::string> more) { return retarget(scans(), std::move(more)); }
};

TEST_F(PosePicturesCommand, RetargetWritesAFilmAndItsPoses) {
  const Finished done = film({"--out", out("control.mp4"), "--canvas", "320x240", "--count", "4n+1"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(out_files().size(), 2u);
  const KeypointReading read = read_keypoints(out("control.json"));
  EXPECT_EQ(read.frames.size(), 5u);
  EXPECT_EQ(read.canvas, (Canvas{320, 240}));
  EXPECT_GT(points_seen(*read.performing().at(0)), 12);
}

TEST_F(PosePicturesCommand, ExportWritesAFolderWithDepthBeside) {
  const Finished done = run_program({"export",   "--source",    scans(),    "--target",      target(),
                                     "--format", "poses",       "--out",    out("control"),  "--camera",
                                     "yaw=180",  "--count",     "3",        "--depth",       "--points",
                                     "body25",   "--pose-file", "openpose", "--stick-width", "6"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(render::read_png(out("control/frame_00002.png")).width, 832);
  EXPECT_EQ(render::read_png(out("control_depth/frame_00002.png")).height, 480);
  EXPECT_FALSE(read_keypoints(out("control_openpose")).performing().at(0)->has(body25::Nose));
}

TEST_F(PosePicturesCommand, BadInputIsASentence) {
  expect_clean_failure(film({"--out", out("a.mp4"), "--camera", "none.json"}), "none.json");
  expect_clean_failure(film({"--out", out("a.mp4"), "--camera", "yaw=left"}), "is no number");
  expect_clean_failure(film({"--out", out("a.mp4"), "--canvas", "0x480"}), "0x480");
  expect_clean_failure(film({"--out", out("a.mp4"), "--count", "none"}), "4n+1");
  expect_clean_failure(film({"--out", out("a.mp4"), "--stick-width", "thick"}), "--stick-width");
  expect_clean_failure(film({"--out", out("a.glb"), "--canvas", "320x240"}), "shows no pictures");
  const std::string far = scratch.path("far.json");
  write_text(far, R"({"target": [90, 0, 0], "distance_m": 2})");
  expect_clean_failure(film({"--out", out("a.mp4"), "--camera", far}), "nobody is in the camera's view");
}

}  // namespace
}  // namespace understudy::tests
