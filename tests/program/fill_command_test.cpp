// `understudy fill`: frames that are missing are made, and said to be.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "retarget/character/read_character.hpp"
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
  Finished fill(const std::string& source, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"fill",  "--source",        source,      "--target", target(),
                                          "--out", out("filled.glb"), "--learned", "0"};
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

TEST_F(Filling, RangesAreMadeToo) {
  const Finished run = fill(scans(), {"--range", "2:3", "--report", out("report.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("report.json")));
  ASSERT_EQ(report["made_frames"].size(), 1u) << report.dump();
  EXPECT_EQ(report["made_frames"][0]["first"], 2);
  EXPECT_EQ(report["made_frames"][0]["last"], 3);
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

}  // namespace
}  // namespace understudy::tests
