// `understudy export` of the shipped program: good and bad runs, without a window.
#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/scene/made_scene.hpp"

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
  EXPECT_NE(done.out.find("on average"), std::string::npos) << done.out;
  const Character file = read_character(out("a.glb"));
  EXPECT_EQ(file.animations.size(), 2u);
  EXPECT_EQ(file.animations[1].name, "scans");
  EXPECT_EQ(file.nodes[2].name, "mixamorig:Hips");
  const auto report = nlohmann::json::parse(read_bytes(out("a.json")));
  EXPECT_EQ(report["rig"], "own");
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

/// Somebody who walks at x = -1, and somebody who dances at x = 1, on a ground; behind them a third one.
constexpr int kSceneFrames = 6;
std::string write_scene(const std::string& path, bool with_third = false) {
  test::Actor left, right, third;
  left.place = {-1, 0, 0}, right.place = {1, 0, 0.3f};
  left.points = right.points = 3000;
  right.motion = "dance";
  third.place = {0.2f, 0, -1.5f}, third.points = 3000;
  test::MadeScene scene(with_third ? std::vector{left, right, third} : std::vector{left, right});
  scene.add_ground(2, 6000);
  NpyArray points;
  for (int t = 0; t < kSceneFrames; ++t) {
    const Mesh scan = scene.frame(3 * t).scan;
    points.shape = {kSceneFrames, static_cast<int64_t>(scan.vertices.rows()), 3};
    points.values.insert(points.values.end(), scan.vertices.data(),
                         scan.vertices.data() + scan.vertices.size());
  }
  write_npz(path, {{"points", points}});
  return path;
}

/// Middle of the vertices [first, first + count) over the frames, x and z.
Vec3 middle(const Character& file, Eigen::Index first, Eigen::Index count) {
  Vec3 sum = Vec3::Zero();
  for (int t = 0; t < kSceneFrames; ++t)
    sum += vertices_at(file, 0, static_cast<float>(t) / 30)
               .middleRows(first, count)
               .colwise()
               .mean()
               .transpose();
  return sum / kSceneFrames;
}

TEST_F(ExportCommand, SeveralTargetsPerformThePeopleOfASceneInOneFile) {
  MadeCharacter made;
  made.unit = 0.01f, made.arms_down_deg = 45;
  const std::string scene = write_scene(scratch.path("scene.npz")), ann = character(made, "ann.glb");
  const auto perform = [&](const std::string& person, const std::vector<std::string>& targets,
                           const std::string& name) {
    std::vector<std::string> arguments = {"export",   "--source", scene,   "--units", "m",
                                          "--person", person,     "--out", name};
    for (const std::string& target : targets) arguments.insert(arguments.end(), {"--target", target});
    return run_program(arguments);
  };
  expect_clean_failure(perform("all", {ann, ann, ann}, out("a.glb")),
                       "scene.npz: shows 2 people, too few for 3 targets");
  expect_clean_failure(perform("1", {ann, target()}, out("a.glb")),
                       "scene.npz: 2 targets perform as many of its people");
  expect_clean_failure(perform("1,2,3", {ann, target()}, out("a.glb")),
                       "--person 1,2,3 is 3 people, but there are 2 targets");
  expect_clean_failure(perform("1,x", {ann, target()}, out("a.glb")), "--person x: must be a number");
  expect_clean_failure(perform("all", {ann, target()}, out("a.bvh")),
                       "BVH holds one motion, not 2 performers");
  expect_clean_failure(perform("1,7", {ann, ann}, out("a.glb")), "there is no person 7 in it");

  const Finished done = perform("all", {ann, target()}, out("both.glb"));
  ASSERT_EQ(done.code, 0) << done.err;
  const Character both = read_character(out("both.glb"));
  ASSERT_EQ(both.animations.size(), 1u);
  EXPECT_EQ(both.animations[0].name, "scene");
  for (const char* name : {"ann", "target"})
    EXPECT_EQ(std::count_if(both.nodes.begin(), both.nodes.end(),
                            [&](const auto& node) { return node.name == name && node.parent < 0; }),
              1)
        << name;
  const Eigen::Index first = make_character(made).vertex_count(), second = both.vertex_count() - first;
  const Vec3 a = middle(both, 0, first), b = middle(both, first, second);
  EXPECT_NEAR(std::abs(a.x()), 1, 0.4f);
  EXPECT_NEAR(a.x() + b.x(), 0, 0.4f) << "each where their person is";
  EXPECT_NEAR(a.y(), b.y(), 0.3f) << "both at the size of people";

  ASSERT_EQ(perform("2,1", {ann, target()}, out("exchanged.glb")).code, 0);
  const Character exchanged = read_character(out("exchanged.glb"));
  EXPECT_NEAR(middle(exchanged, 0, first).x(), b.x(), 0.2f);
  EXPECT_NEAR(middle(exchanged, first, second).x(), a.x(), 0.2f);

  // For one target each is a clip.
  ASSERT_EQ(perform("all", {ann}, out("clips.glb")).code, 0);
  EXPECT_EQ(read_character(out("clips.glb")).animations.size(), 2u);
  ASSERT_EQ(perform("2,1", {ann}, out("listed.glb")).code, 0);
  EXPECT_EQ(read_character(out("listed.glb")).animations.at(0).name, "scene person 2");
}

TEST_F(ExportCommand, WhoHasNoTargetIsLeftOutAndNamed) {
  const std::string scene = write_scene(scratch.path("scene.npz"), /*with_third=*/true);
  const Finished all =
      run_program({"export", "--source", scene, "--units", "m", "--person", "all", "--target", target(),
                   "--target", target(), "--frames", "2", "--out", out("a.glb")});
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_NE(all.err.find("scene person 3 is left out: there are 2 targets"), std::string::npos) << all.err;
  EXPECT_EQ(read_character(out("a.glb")).skins.size(), 2u);
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

TEST_F(ExportCommand, ADocumentGivesWhatTheStudioExports) {
  const std::string document = scratch.path("dance.understudy");
  write_text(scratch.path("make.us"), "open " + scans() + "\nopen " + character() +
                                          "\nwait\nedit.target_joint 0 left_elbow 0.45 1.4 0\n"
                                          "edit.weights_mirror 0 left\nedit.rotate 0 1 head 0 0.4 0 3\n"
                                          "edit.trim 0 0 3\nedit.skip 0 2 on\nwait\n"
                                          "export.run 0 " +
                                          out("studio.glb") +
                                          " morphs=3\n"
                                          "export.run 0 " +
                                          out("studio.npz") +
                                          "\n"
                                          "document.save_as " +
                                          document + "\nwait\n");
  const Finished made = run_program({"play", scratch.path("make.us"), "--context", "null"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished done = run_program({"export", document, "--out", out("cli.glb"), "--morphs", "3"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(run_program({"export", document, "--take", "1", "--out", out("cli.npz")}).code, 0);
  EXPECT_EQ(read_bytes(out("cli.glb")), read_bytes(out("studio.glb")));
  EXPECT_EQ(read_bytes(out("cli.npz")), read_bytes(out("studio.npz")));
  EXPECT_EQ(read_character(out("cli.glb")).animations[0].tracks[0].times.size(), 3u);
}

TEST_F(ExportCommand, APresetSetsWhatIsNotGiven) {
  expect_clean_failure(run(target(), {"--preset", "maya", "--out", out("c.glb")}),
                       "there is no preset 'maya'");
  const Finished done = run(target(), {"--morphs", "2", "--preset", "unreal", "--out", out("a.glb")});
  ASSERT_EQ(done.code, 0) << done.err;
  const Character file = read_character(out("a.glb"));
  EXPECT_EQ(file.parts[0].joints.cols(), 8);
  EXPECT_EQ(file.parts[0].shapes.size(), 2u);
  EXPECT_EQ(run(character(), {"--preset", "blender", "--out", out("b.glb")}).code, 0) << "its own skin stays";
  EXPECT_EQ(read_character(out("b.glb")).animations.size(), 2u) << "the T-pose, too";
}

TEST_F(ExportCommand, ABvhIsOnTheBonesThatAreAskedFor) {
  expect_clean_failure(run(target(), {"--bones", "own", "--out", out("b.bvh")}), "bones of its own");
  const std::string path = character();
  for (const auto& [bones, hips] : {std::pair{"own", "ROOT mixamorig:Hips"}, {"22", "ROOT pelvis"}}) {
    const Finished done = run(path, {"--bones", bones, "--frames", "2", "--out", out("a.bvh")});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(read_bytes(out("a.bvh")).find(hips), std::string::npos) << bones;
  }
}

TEST_F(ExportCommand, AllTakesOfADocumentAreAFileEach) {
  expect_clean_failure(run(target(), {"--all-takes", "--out", out("all")}), "only a document has takes");
  const std::string document = scratch.path("dance.understudy");
  write_text(scratch.path("make.us"), "open " + scans() + "\nopen " + character() + "\ntarget.add " +
                                          target() + "\ntake.rename 0 one\n" +
                                          "take.rename 1 two\nwait\ndocument.save_as " + document + "\n");
  const Finished made = run_program({"play", scratch.path("make.us"), "--context", "null"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished done = run_program(
      {"export", document, "--all-takes", "--format", "bvh", "--bones", "own", "--out", out("all")});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("2 of 2 takes"), std::string::npos) << done.out;
  EXPECT_NE(read_bytes(out("all/one.bvh")).find("mixamorig:Hips"), std::string::npos);
  EXPECT_NE(read_bytes(out("all/two.bvh")).find("pelvis"), std::string::npos);
  std::filesystem::remove(out("all/one.bvh"));
  std::filesystem::create_directories(out("all/one.bvh/in the way"));
  const Finished part =
      run_program({"export", document, "--all-takes", "--format", "bvh", "--out", out("all")});
  EXPECT_EQ(part.code, 1);
  EXPECT_NE(part.out.find("1 of 2 takes"), std::string::npos) << part.out;
  EXPECT_NE(part.err.find("one.bvh"), std::string::npos) << part.err;
}

TEST_F(ExportCommand, ADocumentThatCannotBeExportedIsASentence) {
  const std::string document = scratch.path("dance.understudy");
  write_text(scratch.path("make.us"),
             "open " + scans() + "\nopen " + target() + "\nwait\ndocument.save_as " + document + "\n");
  ASSERT_EQ(run_program({"play", scratch.path("make.us"), "--context", "null"}).code, 0);
  expect_clean_failure(run_program({"export", document, "--take", "2", "--out", out("a.glb")}),
                       "no take '2'");
  expect_clean_failure(run_program({"export", document, "--rig", "theirs", "--out", out("a.glb")}),
                       "bones of its own");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--target", target()}, {"--path", "original"}, {"--no-lock-feet"}}) {
    std::vector<std::string> arguments = {"export", document, "--out", out("a.glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_clean_failure(run_program(arguments),
                         "its own source and target, " + more[0] + " cannot be combined with it");
  }
  std::string text = read_bytes(document);
  text.replace(text.find("scans"), 5, "gone!");
  write_text(scratch.path("moved.understudy"), text);
  expect_clean_failure(run_program({"export", scratch.path("moved.understudy"), "--out", out("a.glb")}),
                       "does not exist");
}

TEST_F(ExportCommand, CtrlCAndAFullDiskLeaveTheOldFile) {
  std::ofstream(out("a.glb")) << "old";
  ProgramOptions full;
  full.file_size_limit = 20000;
  const Finished stopped =
      run_program({"export", "--source", scans(), "--target", target(), "--out", out("a.glb")}, full);
  EXPECT_EQ(stopped.code, 1) << stopped.err;
  EXPECT_NE(stopped.err.find("cannot be written"), std::string::npos) << stopped.err;
  EXPECT_EQ(read_bytes(out("a.glb")), "old");
  Program program({"export", "--follow", "--source", scans(), "--target", target(), "--out", out("a.glb")});
  ASSERT_TRUE(program.wait_for("frames/s assumed"));
  program.send(SIGINT);
  EXPECT_NE(program.finish().code, 0);
  EXPECT_EQ(read_bytes(out("a.glb")), "old");
  EXPECT_EQ(out_files().size(), 1u);
}

TEST_F(ExportCommand, EveryFormatIsWrittenWithoutAWindow) {
  const std::string path = character();
  for (const auto& [format, name] : std::vector<std::pair<std::string, std::string>>{{"bvh", "a.bvh"},
                                                                                     {"amass", "amass.npz"},
                                                                                     {"ply", "frames"},
                                                                                     {"pc2", "a.pc2"},
                                                                                     {"joints", "a.csv"}}) {
    const Finished done = run(path, {"--format", format, "--out", out(name), "--frames", "2"});
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("bytes"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(out(name))) << name;
  }
}

TEST_F(ExportCommand, PerformsAsRetargetDoesWithTheSameOptions) {
  const std::string path = character();
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--root", "in-place"},
        {"--root", "original", "--no-foot-lock"},
        {"--target-turn", "0", "--fps", "50", "--engine", "copy"}}) {
    std::vector<std::string> exported = {"--out", out("export.bvh")},
                             retargeted = {"--out", out("retarget.bvh")};
    exported.insert(exported.end(), options.begin(), options.end());
    retargeted.insert(retargeted.end(), options.begin(), options.end());
    retargeted.insert(retargeted.begin(), {"retarget", "--source", scans(), "--target", path});
    const Finished one = run(path, exported), other = run_program(retargeted);
    ASSERT_EQ(one.code, 0) << one.err;
    ASSERT_EQ(other.code, 0) << other.err;
    EXPECT_EQ(read_bytes(out("export.bvh")), read_bytes(out("retarget.bvh"))) << options[1];
  }
}

TEST_F(ExportCommand, SaysWhatIsWrong) {
  const std::string path = character();
  std::ofstream(scratch.path("twice.json")) << R"({"head": "mixamorig:Neck", "neck": "mixamorig:Neck"})";
  std::ofstream(scratch.path("list.json")) << "[1]";
  expect_clean_failure(run(path, {"--out", out("a.fbx")}), "use .glb, .gltf, .bvh");
  expect_clean_failure(run(path, {"--out", out("a.glb"), "--map", scratch.path("twice.json")}), "to both");
  std::ofstream(scratch.path("none.json")) << R"({"head": "Nobody"})";
  expect_clean_failure(run(path, {"--out", out("a.glb"), "--map", scratch.path("none.json")}),
                       "made.glb: the map names a bone 'Nobody'");
  const std::string moving = scratch.path("moving.glb");
  ASSERT_EQ(run(path, {"--out", moving}).code, 0);
  expect_clean_failure(run_program({"export", "--source", moving, "--source-map", scratch.path("none.json"),
                                    "--target", target(), "--out", out("a.glb")}),
                       "moving.glb: ");
  expect_clean_failure(run(path, {"--out", out("a.glb"), "--map", scratch.path("list.json")}),
                       "no map of bones");
  expect_clean_failure(run(target(), {"--out", out("a.glb"), "--rig", "theirs"}), "has no skeleton");
  expect_clean_failure(run(scratch.path("gone.glb"), {"--out", out("a.glb")}), "gone.glb");
  std::ofstream(scratch.path("bad.fbx")) << "Kaydara FBX Binary  and then nothing";
  expect_clean_failure(run(scratch.path("bad.fbx"), {"--out", out("a.glb")}), "bad.fbx");
}

}  // namespace
}  // namespace understudy::tests
