// `understudy sheet`, and the pictures that are made with it.
#include <algorithm>
#include <filesystem>

#include "render/image.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;

const std::string kSamples = US_SOURCE_DIR "/assets/samples/";

class Sheet : public ShippedProgram {
 protected:
  std::string walk() const {
    const std::string path = scratch.path("walk.npz");
    if (!fs::exists(path)) write_walk(path);
    return path;
  }
  Finished sheet(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"sheet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(Sheet, HasARowForEachFileWhateverItHolds) {
  ASSERT_EQ(run_program({"retarget", "--source", scans(), "--target", target(), "--out", out("a.glb")}).code,
            0);
  const Finished done = sheet({walk(), out("a.glb"), scans(), "--out", out("all.png"), "--every", "0.1",
                               "--captions", "bones,character,scan"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("3 rows, 50 moments"), std::string::npos) << done.out;
  EXPECT_EQ(render::read_png(out("all.png")).width, 1800);
}

TEST_F(Sheet, FilesBeginWhereTheyAreAskedTo) {
  for (const char* const from : {"", "@1"})
    ASSERT_EQ(sheet({walk() + from, "--seconds", "0", "--out", out("at" + std::string(from) + ".png")}).code,
              0);
  EXPECT_NE(read_bytes(out("at.png")), read_bytes(out("at@1.png")));
  const Finished later = sheet({walk(), "--from", "1", "--seconds", "0", "--out", out("from.png")});
  EXPECT_NE(later.out.find("1 rows, 1 moments"), std::string::npos) << later.out;
}

TEST_F(Sheet, PosesAndPicturesOfThemHaveRowsOfTheirOwn) {
  ASSERT_EQ(run_program({"retarget", "--source", kSamples + "poses", "--target", kSamples + "reference.json",
                         "--out", scratch.path("frames")})
                .code,
            0);
  const Finished done = sheet({kSamples + "poses", kSamples + "reference.json", scratch.path("frames"),
                               "--every", "0.5", "--out", scratch.path("flat.png")});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("3 rows, 6 moments"), std::string::npos) << done.out;
  const render::Image picture = render::read_png(scratch.path("flat.png"));
  EXPECT_EQ(picture.width, 1800);
  EXPECT_GT(std::count(picture.pixels.begin(), picture.pixels.end(), uint8_t{0}), picture.width * 100)
      << "poses stand on black";
  expect_clean_failure(sheet({kSamples + "poses", walk(), "--out", out("mixed.png")}), "poses");
}

TEST_F(Sheet, RigsAreShownWithTheirBones) {
  const std::string rig = scratch.path("a.glb");
  ASSERT_EQ(run_program({"retarget", "--source", scans(), "--target", target(), "--out", rig}).code, 0);
  for (const std::string file : {"with.png", "without.png"}) {
    std::vector<std::string> words = {rig, rig, "--seconds", "0", "--out", scratch.path(file)};
    if (file == "with.png") words.emplace_back("--bones");
    const Finished done = sheet(words);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("2 rows, 1 moments"), std::string::npos) << done.out;
  }
  EXPECT_NE(read_bytes(scratch.path("with.png")), read_bytes(scratch.path("without.png")));
  expect_clean_failure(sheet({walk(), "--bones", "--out", out("no.png")}), "walk.npz");
}

TEST_F(Sheet, RefusesWhatItCannotShow) {
  const std::string file = scratch.path("x.png");
  expect_clean_failure(sheet({walk(), "--captions", "a,b", "--out", file}),
                       "--captions has 2, the sheet 1 rows");
  expect_clean_failure(sheet({walk(), "--from", "60", "--out", file}), "--from 60: it lasts 4.97 s");
  expect_clean_failure(sheet({walk(), "--every", "0.001", "--out", file}), "more than 240 moments");
  expect_clean_failure(sheet({walk(), "--motion", "walk", "--out", file}), "--motion is of a study");
  expect_clean_failure(sheet({"a.study", walk(), "--out", file}), "a study is shown by itself");
  expect_clean_failure(sheet({"a.study", "--bones", "--out", file}), "--bones is of rigs");
  expect_clean_failure(sheet({scratch.path("none.glb"), "--out", file}), "none.glb");
}

/// Those that screenshots/SCRIPT makes without a data folder, and that are in the repository.
class PictureScript : public Sheet {
 protected:
  void expect_made(const std::string& script, const std::vector<std::string>& names) {
    ProgramOptions options;
    options.program = US_SOURCE_DIR "/screenshots/" + script;
    options.environment = {"UNDERSTUDY=" US_PROGRAM, "OUT=" + scratch.path("pictures")};
    options.patience_s = 900;
    fs::create_directories(scratch.path("pictures"));
    const Finished run = run_program({}, options);
    ASSERT_EQ(run.code, 0) << run.err;
    for (const std::string& name : names) {
      EXPECT_GE(render::read_png(scratch.path("pictures/" + name + ".png")).width, 1280) << name;
      EXPECT_TRUE(fs::exists(US_SOURCE_DIR "/screenshots/" + name + ".webp")) << name;
    }
  }
};

TEST_F(PictureScript, MakesThoseOfStyles) {
  expect_made("performance.sh", {"47_performance", "48_style_wipe", "49_style_trails", "50_teach_style",
                                 "52_style_walk", "53_style_stimuli"});
}

TEST_F(PictureScript, MakesThoseOfFlatPeople) {
  expect_made("flat.sh",
              {"55_flat_dance", "56_flat_crowd", "57_flat_turn", "59_flat_studio", "60_flat_lifted"});
}

TEST_F(PictureScript, MakesThoseOfKeypointsAndMoreMotion) {
  expect_made("marionette.sh", {"61_more_motion", "62_between_frames", "63_keypoints", "64_between_poses"});
}

}  // namespace
}  // namespace understudy::tests
