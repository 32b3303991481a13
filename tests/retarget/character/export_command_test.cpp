// `understudy export` of the shipped program: good and bad runs, without a window.
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

class ExportCommand : public ShippedProgram {
 protected:
  /// A character as a file; its path.
  std::string character(const MadeCharacter& made = {}, const std::string& name = "made.glb") {
    write_gltf_character(scratch.path(name), make_character(made));
    return scratch.path(name);
  }
  Finished run(const std::string& target, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"export", "--source", scans(), "--target", target};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(ExportCommand, HasHelpAndHidesItsWorker) {
  const Finished help = run_program({"export", "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("--print-map"), std::string::npos);
  EXPECT_EQ(run_program({"--help"}).out.find("import-worker"), std::string::npos);
}

TEST_F(ExportCommand, WritesTheCharacterOnItsOwnSkeleton) {
  MadeCharacter made;
  made.arms_down_deg = 45;
  made.unit = 0.01f;
  const Finished done = run(character(made), {"--out", out("a.glb"), "--preview", out("a.png"), "--report",
                                              out("a.json"), "--t-pose-clip", "--in-place"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("mean"), std::string::npos);
  const Character file = read_character(out("a.glb"));
  EXPECT_EQ(file.animations.size(), 2u);
  EXPECT_EQ(file.animations[1].name, "scans");
  EXPECT_EQ(file.nodes[2].name, "mixamorig:Hips");
  const auto report = nlohmann::json::parse(read_bytes(out("a.json")));
  EXPECT_EQ(report["rig"], "theirs");
  EXPECT_EQ(report["mapped"], 22);
  EXPECT_LT(report["cost"]["mean_mm"], 5);
  EXPECT_EQ(out_files().size(), 3u);
}

TEST_F(ExportCommand, WritesABareMeshOnOurJoints) {
  const Finished done = run(target(), {"--out", out("a.gltf"), "--influences", "8", "--morphs", "2"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Character file = read_character(out("a.gltf"));
  EXPECT_EQ(file.nodes[0].name, "pelvis");
  EXPECT_EQ(file.parts[0].joints.cols(), 8);
}

TEST_F(ExportCommand, TwoSourcesAreTwoClips) {
  const Finished done = run(character(), {"--source", scans(), "--out", out("a.glb"), "--reduce", "2"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(read_character(out("a.glb")).animations.size(), 2u);
}

TEST_F(ExportCommand, ShowsTheMapAndTakesCorrections) {
  const std::string path = character();
  const Finished shown = run_program({"export", "--target", path, "--print-map"});
  ASSERT_EQ(shown.code, 0) << shown.err;
  EXPECT_NE(shown.out.find("mixamorig:LeftForeArm"), std::string::npos);
  std::ofstream(scratch.path("map.json")) << R"({"head": ""})";
  const Finished less =
      run_program({"export", "--target", path, "--print-map", "--map", scratch.path("map.json")});
  EXPECT_EQ(less.out.find("mixamorig:Head "), std::string::npos) << less.out;
}

TEST_F(ExportCommand, SaysWhatIsWrong) {
  const std::string path = character();
  std::ofstream(scratch.path("twice.json")) << R"({"head": "mixamorig:Neck", "neck": "mixamorig:Neck"})";
  std::ofstream(scratch.path("list.json")) << "[1]";
  expect_clean_failure(run(path, {"--out", out("a.fbx")}), "use .glb or .gltf");
  expect_clean_failure(run(path, {"--out", out("a.glb"), "--map", scratch.path("twice.json")}), "to both");
  expect_clean_failure(run(path, {"--out", out("a.glb"), "--map", scratch.path("list.json")}),
                       "no map of bones");
  expect_clean_failure(run(target(), {"--out", out("a.glb"), "--rig", "theirs"}), "has no skeleton");
  expect_clean_failure(run(scratch.path("gone.glb"), {"--out", out("a.glb")}), "gone.glb");
  std::ofstream(scratch.path("bad.fbx")) << "Kaydara FBX Binary  and then nothing";
  expect_clean_failure(run(scratch.path("bad.fbx"), {"--out", out("a.glb")}), "bad.fbx");
}

}  // namespace
}  // namespace understudy::tests
