// --complete and --markers of the shipped program's commands, good and bad.
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/formats/npz.hpp"
#include "retarget/formats/scan_source.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class CompleteOption : public ShippedProgram {
 protected:
  /// Every fifth scan of the bundled sample, 100 points of each.
  void SetUp() override {
    ScanSource sample(US_SOURCE_DIR "/assets/samples/scan");
    std::filesystem::create_directories(scratch.path("few"));
    for (int t = 0; const auto scan = sample.next(); ++t) {
      if (t % 5 != 0 || t > 30) continue;
      Rng rng(static_cast<uint64_t>(t));
      write_cloud(scratch.path("few/frame_" + std::to_string(t) + ".ply"),
                  sample_points(scan->mesh, 100, rng));
    }
  }
  std::string few() const { return scratch.path("few"); }
};

TEST_F(CompleteOption, IsInTheHelp) {
  for (const char* command : {"retarget", "export", "measure", "fill"}) {
    const std::string help = run_program({command, "--help"}).out;
    EXPECT_NE(help.find("--complete"), std::string::npos) << command;
    EXPECT_NE(help.find("--markers"), std::string::npos) << command;
  }
}

TEST_F(CompleteOption, MakesAMotionOfSevenScansOfAHundredPoints) {
  const Finished run =
      retarget(few(), {"--fps", "6", "--complete", "60", "--out", out("a.npz"), "--report", out("r.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("7 scans completed to 60 frames/s, 54 of 61 frames are made (looks both ways)"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(read_npz(out("a.npz")).at("joints").shape, (std::vector<int64_t>{61, 22, 3}));
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_EQ(report["fps"], 60);
  EXPECT_EQ(report["frames"], 61);
  EXPECT_EQ(report["flagged"], 0);
  ASSERT_EQ(report["made_frames"].size(), 6u);
  EXPECT_EQ(report["made_frames"][0]["first"], 1);
  EXPECT_EQ(report["made_frames"][0]["last"], 9);
  EXPECT_GT(report["made_frames"][0]["doubt_m"], 0);
}

TEST_F(CompleteOption, GivesTheSameBytesTwice) {
  for (const char* name : {"a.npz", "b.npz"})
    ASSERT_EQ(retarget(few(), {"--fps", "6", "--complete", "30", "--out", out(name)}).code, 0);
  EXPECT_EQ(read_bytes(out("a.npz")), read_bytes(out("b.npz")));
}

TEST_F(CompleteOption, RefusesInOneSentence) {
  std::ofstream(scratch.path("m.csv")) << "seconds,name,x,y,z\n0,tail,0,0,0\n0,wing,0,0,0\n0,horn,0,0,0\n";
  expect_clean_failure(retarget(few(), {"--markers", scratch.path("m.csv"), "--out", out("a.npz")}),
                       "are for scans that are completed (--complete)");
  expect_clean_failure(
      retarget(few(), {"--complete", "30", "--markers", scratch.path("m.csv"), "--out", out("a.npz")}),
      "m.csv: there is no place for a marker 'horn'");
  expect_clean_failure(retarget(few(), {"--complete", "30", "--follow", "--out", out("a.npz")}),
                       "(--follow)");
  std::ofstream(scratch.path("walk.bvh")) << "HIERARCHY\n";
  expect_clean_failure(retarget(scratch.path("walk.bvh"), {"--complete", "30", "--out", out("a.npz")}),
                       "is a motion already, only scans are completed");
}

}  // namespace
}  // namespace understudy::tests
