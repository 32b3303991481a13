// `understudy fill`: frames that are missing are made, and said to be.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class Filling : public ShippedProgram {
 protected:
  /// Eight scans, of which 3 and 4 are missing.
  std::string gaps() {
    const std::string folder = scratch.path("gaps");
    write_scans(folder, 8);
    for (const char* missing : {"/frame_00003.ply", "/frame_00004.ply"})
      EXPECT_TRUE(std::filesystem::remove(folder + missing));
    return folder;
  }
  Finished fill(const std::string& source, std::vector<std::string> more, const std::string& learned = "0") {
    std::vector<std::string> arguments = {"fill",  "--source",        source,      "--target", target(),
                                          "--out", out("filled.glb"), "--learned", learned};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(Filling, MissingFramesAreMadeAndTold) {
  const Finished run = fill(gaps(), {"--bad", "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("frames 3 to 4 were made, expected to be off by up to "), std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find(", 8 frames"), std::string::npos) << run.out;
  const Json report = Json::parse(read_bytes(out("report.json")));
  EXPECT_EQ(report["frames"], 8) << "as long as what was captured";
  ASSERT_EQ(report["made_frames"].size(), 1u) << report.dump();
  EXPECT_EQ(report["made_frames"][0]["first"], 3);
  EXPECT_EQ(report["made_frames"][0]["last"], 4);
  EXPECT_GT(report["made_frames"][0]["doubt_m"].get<double>(), 0);
  const Character character = read_character(out("filled.glb"));
  ASSERT_EQ(character.animations.size(), 1u);
  EXPECT_EQ(character.animations[0].tracks.at(0).times.size(), 8u);
}

TEST_F(Filling, FramesPredictedWhilePerformingAreToldToo) {
  for (const bool predicts : {false, true}) {
    std::vector<std::string> more = {"--out", out("p.glb"), "--report", out("p.json")};
    if (predicts) more.push_back("--predict");
    const Finished run = retarget(gaps(), more);
    ASSERT_EQ(run.code, 0) << run.err;
    const Json report = Json::parse(read_bytes(out("p.json")));
    EXPECT_EQ(report["flagged"], 2) << "as ever";
    EXPECT_EQ(read_bytes(out("p.glb")).find("made_frames") != std::string::npos, predicts);
    ASSERT_EQ(report.contains("made_frames"), predicts);
    if (!predicts) continue;
    ASSERT_EQ(report["made_frames"].size(), 1u) << report.dump();
    EXPECT_EQ(report["made_frames"][0]["first"], 3);
    EXPECT_EQ(report["made_frames"][0]["last"], 4);
    EXPECT_GT(report["made_frames"][0]["doubt_m"].get<double>(), 0);
  }
}

TEST_F(Filling, RangesAreMadeToo) {
  const Finished run = fill(scans(), {"--range", "2:3", "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("report.json")));
  ASSERT_EQ(report["made_frames"].size(), 1u) << report.dump();
  EXPECT_EQ(report["made_frames"][0]["first"], 2);
  EXPECT_EQ(report["made_frames"][0]["last"], 3);
}

TEST_F(Filling, AlternativesDifferAndAreTheSameTwice) {
  const auto made = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--until", "0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = fill(scans(), arguments, "1");
    EXPECT_EQ(run.code, 0) << run.err;
    return read_bytes(out("filled.glb"));
  };
  const std::string best = made({}), other = made({"--variation", "2"});
  EXPECT_EQ(made({"--variation", "0"}), best);
  EXPECT_EQ(made({"--variation", "2"}), other);
  EXPECT_NE(other, best);
  const Finished none = fill(scans(), {"--variation", "4"});
  EXPECT_GT(none.code, 0);
  EXPECT_NE(none.err.find("--variation: Value 4 not in range"), std::string::npos) << none.err;
}

TEST_F(Filling, RangesThatAreNoneAreRefused) {
  for (const char* range : {"4", "a:b", "-1:3", "1.5:2", ":"})
    expect_clean_failure(fill(scans(), {"--range", range}), "is not FIRST:LAST, two numbers of frames");
  expect_clean_failure(fill(scans(), {"--range", "3:90"}), "90");
  expect_clean_failure(fill(scans(), {"--range", "0:4"}), "none is left that is known");
}

TEST_F(Filling, WithNothingBadSaysSoAndWritesAllTheSame) {
  const Finished run = fill(scans(), {"--bad", "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("all of its frames could be used"), std::string::npos) << run.err << run.out;
  EXPECT_TRUE(Json::parse(read_bytes(out("report.json")))["made_frames"].empty());
}

TEST_F(Filling, GoesOnUntilATime) {
  const Finished run = fill(scans(), {"--until", "0.5", "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("frames 5 to 14 are a guess: nothing after them is known"), std::string::npos)
      << run.err;
  const Json report = Json::parse(read_bytes(out("report.json")));
  EXPECT_EQ(report["frames"], 15) << "half a second at 30 frames/s";
  ASSERT_EQ(report["made_frames"].size(), 1u) << report.dump();
  EXPECT_EQ(report["made_frames"][0]["first"], 5);
  EXPECT_EQ(report["made_frames"][0]["last"], 14);
  EXPECT_EQ(read_character(out("filled.glb")).animations.at(0).tracks.at(0).times.size(), 15u);
}

TEST_F(Filling, MakesAWalkALoop) {
  const Joints& rest = human_rest();
  const Motion walk = builtin_motion("walk", rest);
  BvhWriter writer(scratch.path("walk.bvh"), rest, walk.fps);
  for (const Pose& pose : walk.poses) writer.push(pose);
  writer.finish();
  const Finished run = fill(scratch.path("walk.bvh"), {"--loop", "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find(" of the source play in a loop, "), std::string::npos) << run.out;
  const Json report = Json::parse(read_bytes(out("report.json")));
  const int first = report["loop"]["first"], last = report["loop"]["last"];
  EXPECT_EQ(report["frames"], last - first + 1);
  EXPECT_GT(report["loop"]["travel_m"].get<double>(), 0.5);
  ASSERT_EQ(report["made_frames"].size(), 2u) << "both sides of the seam: " << report.dump();
  EXPECT_EQ(report["made_frames"][0]["first"], 0) << "as the written clip counts";
  EXPECT_EQ(report["made_frames"][1]["last"], last - first);
}

TEST_F(Filling, FollowsCurvesWhereTheMotionSpaceIsOfAnotherVersionAndSaysSo) {
  namespace fs = std::filesystem;
  const std::string folder = scratch.path("weights"), name = "motion_space.weights";
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(std::string(US_SOURCE_DIR) + "/assets/weights"))
    if (entry.path().extension() == ".weights" && entry.path().filename() != name)
      fs::create_symlink(entry.path(), folder + "/" + entry.path().filename().string());
  std::string bytes = read_bytes(std::string(US_SOURCE_DIR) + "/assets/weights/" + name);
  const std::string key = "\"version\":";
  const size_t at = bytes.find(key);
  ASSERT_NE(at, std::string::npos);
  bytes[at + key.size()] = '9';
  std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
  const Finished run =
      run_program({"fill", "--source", gaps(), "--target", target(), "--out", out("filled.glb"), "--bad",
                   "--weights", folder, "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("weights of version 9"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("what is made follows smooth curves"), std::string::npos) << run.err;
  const Json report = Json::parse(read_bytes(out("report.json")));
  EXPECT_EQ(report["learned"], 0);
  EXPECT_EQ(report["made_frames"].size(), 1u);
}

TEST_F(Filling, AGapAtAnEndIsSaidToBeAGuess) {
  const Finished start = fill(scans(), {"--range", "0:1"});
  ASSERT_EQ(start.code, 0) << start.err;
  EXPECT_NE(start.err.find("frames 0 to 1 are a guess: nothing before them is known"), std::string::npos)
      << start.err;
  const Finished one = fill(scans(), {"--range", "0:3"});
  EXPECT_EQ(one.code, 0) << "one known frame is enough: " << one.err;
}

TEST_F(Filling, RefusesTimesThatHavePassedAndLoopsThatAreNone) {
  expect_clean_failure(fill(scans(), {"--until", "0.1"}), "seconds long already");
  expect_clean_failure(fill(scans(), {"--until", "900"}), "a take goes on for");
  expect_clean_failure(fill(scans(), {"--loop"}), "are alike: there is no loop in them");
  const Finished both = fill(scans(), {"--loop", "--until", "2"});
  EXPECT_GT(both.code, 0);
  EXPECT_NE(both.err.find("--until excludes --loop"), std::string::npos) << both.err;
}

}  // namespace
}  // namespace understudy::tests
