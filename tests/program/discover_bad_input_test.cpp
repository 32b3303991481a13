// What the program does where no skeleton can be found, or rigs are not as it wrote them.
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"
#include "tests/support/moving_arm.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

/// So many bones in a row, each with two rings of a thin tube; it sways.
RiggedMotion chain(int bones) {
  constexpr int kSides = 6, kFrames = 4;
  RiggedMotion chain;
  chain.rig.name = "chain";
  Mesh& surface = chain.rig.surface;
  surface.vertices.resize(2 * bones * kSides, 3);
  surface.faces.resize(2 * (2 * bones - 1) * kSides, 3);
  std::vector<int> bone_of;
  for (int v = 0, f = 0; v < surface.vertices.rows(); ++v) {
    const int ring = v / kSides, next = ring * kSides + (v + 1) % kSides;
    const float angle = 2 * kPi * static_cast<float>(v % kSides) / kSides;
    surface.vertices.row(v) << 1.5f * static_cast<float>(ring) / static_cast<float>(bones),
        0.05f * std::cos(angle), 0.03f * std::sin(angle);
    bone_of.push_back(ring / 2);
    if (ring + 1 == 2 * bones) continue;
    surface.faces.row(f++) << v, next, v + kSides;
    surface.faces.row(f++) << next, next + kSides, v + kSides;
  }
  chain.rig.skin = SkinWeights::rigid(bone_of);
  for (int j = 0; j < bones; ++j)
    chain.rig.joints.push_back({"link " + std::to_string(j),
                                j - 1,
                                j == 0 ? JointKind::Free : JointKind::Ball,
                                {3 * static_cast<float>(j) / static_cast<float>(bones), 0, 0},
                                Vec3::UnitY()});
  for (int t = 0; t < kFrames; ++t) {
    RigPose pose = rest_pose(chain.rig);
    for (int j = 1; j < bones; ++j)
      pose.turns[j] = rotation_from_axis_angle({0, 0, 0.6f * t / bones * std::sin(15.0f * j / bones)});
    chain.motion.poses.push_back(pose);
  }
  return chain;
}

class DiscoverBadInput : public ShippedProgram {
 protected:
  /// Scans as one array.
  std::string array(const std::string& name, const std::vector<Mesh>& scans) {
    NpyArray points;
    points.shape = {ssize(scans), scans[0].vertices.rows(), 3};
    for (const Mesh& scan : scans)
      points.values.insert(points.values.end(), scan.vertices.data(),
                           scan.vertices.data() + scan.vertices.size());
    write_npz(scratch.path(name), {{"points", points}});
    return scratch.path(name);
  }
  std::string arm(const std::string& name, int frames, float turn = 0.15f) {
    std::vector<Mesh> scans;
    for (int t = 0; t < frames; ++t) scans.push_back(bent_arm(turn * static_cast<float>(t), t));
    return array(name, scans);
  }
  std::string rig(const std::string& name, const RiggedMotion& performed) {
    write_gltf_character(scratch.path(name), to_character(performed));
    return scratch.path(name);
  }
  static Finished discover(const std::string& source, std::vector<std::string> more,
                           ProgramOptions options = {}) {
    std::vector<std::string> arguments = {"discover", "--source", source};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, std::move(options));
  }
  Json report(const std::string& name) { return Json::parse(read_bytes(out(name))); }
};

TEST_F(DiscoverBadInput, OneFrame) {
  expect_clean_failure(discover(arm("one.npz", 1), {"--out", out("a.glb")}),
                       "one.npz: a skeleton is found in how");
}

TEST_F(DiscoverBadInput, NothingThatMoves) {
  const Finished run = discover(arm("still.npz", 3, 0), {"--out", out("a.glb")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("1 bone: nothing moves against anything else"), std::string::npos) << run.out;
  EXPECT_EQ(read_character(out("a.glb")).skins[0].joints.size(), 1u);
}

TEST_F(DiscoverBadInput, CoordinatesThatAreNoNumbersThroughout) {
  Mesh none{Points::Constant(500, 3, std::numeric_limits<float>::quiet_NaN())};
  const std::string source = array("nan.npz", {none, none, none});
  expect_clean_failure(discover(source, {"--out", out("a.glb")}), "nan.npz: ");
  const std::string known = rig("arm.glb", test::bending_arm(3));
  expect_clean_failure(discover(source, {"--rig", known, "--out", out("a.glb")}),
                       "nan.npz: no scan has 30 points");
  expect_clean_failure(
      run_program({"discover", "--rig", known, "--perform", array("one.npz", {none}), "--out", out("a.glb")}),
      "one.npz: ");
}

TEST_F(DiscoverBadInput, FramesCutShortAreToldAndTheOthersUsed) {
  std::filesystem::create_directories(scratch.path("scans"));
  for (int t = 0; t < 5; ++t) {
    const std::string path = scratch.path("scans/" + frame_name(t));
    write_cloud(path, bent_arm(0.3f * static_cast<float>(t), t).vertices);
    if (t == 2) std::filesystem::resize_file(path, 900);
  }
  const Finished run = discover(scratch.path("scans"), {"--out", out("a.glb"), "--report", out("a.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("1 of 5 frames fit clearly worse or could not be used"), std::string::npos)
      << run.out;
  EXPECT_EQ(report("a.json")["doubted"], Json({2}));
}

TEST_F(DiscoverBadInput, CtrlCLeavesTheBestFoundSoFarOrNothing) {
  Program program({"discover", "--source", arm("long.npz", 40, 0.03f), "--out", out("a.glb")});
  ASSERT_TRUE(program.wait_for("finding its skeleton"));
  program.send(SIGINT);
  const Finished run = program.finish();
  if (run.code != 0) return expect_clean_failure(run, "long.npz: ended before a skeleton was found");
  EXPECT_NE(run.out.find("ended early"), std::string::npos) << run.out;
  EXPECT_EQ(from_character(read_character(out("a.glb")), 0, 30).motion.poses.size(), 40u);
  EXPECT_EQ(out_files().size(), 1u);
}

TEST_F(DiscoverBadInput, KilledItLeavesWhatWasThere) {
  write_text(out("a.glb"), "before");
  Program program({"discover", "--source", arm("long.npz", 40, 0.03f), "--out", out("a.glb"), "--result",
                   out("a.npz"), "--preview", out("a.png")});
  ASSERT_TRUE(program.wait_for("finding its skeleton"));
  program.send(SIGKILL);
  EXPECT_EQ(program.finish().code, 128 + SIGKILL);
  EXPECT_EQ(out_files(), std::vector<std::string>{"a.glb"});
  EXPECT_EQ(read_bytes(out("a.glb")), "before");
}

TEST_F(DiscoverBadInput, AFullDisk) {
  const std::string source = arm("arm.npz", 3), known = rig("arm.glb", test::bending_arm(3));
  ProgramOptions full;
  full.file_size_limit = 200;
  for (const auto& [option, name] : std::vector<std::pair<std::string, std::string>>{{"--out", "a.glb"},
                                                                                     {"--out", "a.gltf"},
                                                                                     {"--out", "a.bvh"},
                                                                                     {"--result", "a.npz"},
                                                                                     {"--report", "a.json"},
                                                                                     {"--preview", "a.png"}})
    expect_clean_failure(discover(source, {"--rig", known, option, out(name)}, full), name);
}

TEST_F(DiscoverBadInput, ARigOfThreeHundredBonesIsFollowedAndPerformed) {
  const RiggedMotion long_one = chain(300);
  const std::string file = rig("chain.glb", long_one);
  std::vector<Mesh> scans = test::scans_of(long_one);
  const Finished followed = discover(array("scans.npz", scans), {"--rig", file, "--out", out("a.glb")});
  ASSERT_EQ(followed.code, 0) << followed.err;
  EXPECT_EQ(followed.err.find("another body"), std::string::npos) << followed.err;
  EXPECT_EQ(read_character(out("a.glb")).skins[0].joints.size(), 300u);
  const Finished performed =
      run_program({"discover", "--rig", file, "--perform", out("a.glb"), "--out", out("b.glb")});
  ASSERT_EQ(performed.code, 0) << performed.err;
  EXPECT_EQ(from_character(read_character(out("b.glb")), 0, 30).motion.poses.size(), scans.size());
}

TEST_F(DiscoverBadInput, ScansOfAnotherBodyAreToldOf) {
  Mesh ball{0.2f * Points::Random(2000, 3).rowwise().normalized()};
  const Finished followed = discover(array("ball.npz", {ball, ball, ball}),
                                     {"--rig", rig("chain.glb", chain(10)), "--out", out("a.glb")});
  ASSERT_EQ(followed.code, 0) << followed.err;
  EXPECT_NE(followed.err.find("ball.npz: is "), std::string::npos) << followed.err;
  EXPECT_NE(followed.err.find("it may be of another body"), std::string::npos) << followed.err;
}

TEST_F(DiscoverBadInput, BonesWithoutAPartner) {
  RiggedMotion stiff = chain(300);
  const std::string many = rig("many.glb", stiff);
  stiff.rig.joints.resize(1);
  stiff.rig.skin = SkinWeights::rigid(std::vector<int>(static_cast<size_t>(stiff.rig.skin.size()), 0));
  for (RigPose& pose : stiff.motion.poses) pose = rest_pose(stiff.rig);
  expect_clean_failure(
      run_program({"discover", "--rig", rig("stiff.glb", stiff), "--perform", many, "--out", out("a.glb")}),
      "many.glb: no bone has a partner");
  const std::string arm = rig("arm.glb", test::bending_arm(3)), matches = scratch.path("m.json");
  write_text(matches, R"({"bones": [{"bone": "elbow", "partner": null}]})");
  expect_clean_failure(
      run_program({"discover", "--rig", arm, "--perform", arm, "--matches", matches, "--out", out("a.glb")}),
      "m.json: no bone has a partner");
}

/// What another program may make of a rig: bones with its names, in another order, under a node of its own.
void change_as_others_do(const std::string& path) {
  Json file = Json::parse(read_bytes(path));
  const int count = static_cast<int>(file["nodes"].size());
  const auto renumber = [&](Json& node) { node = count - 1 - node.get<int>(); };
  for (Json& node : file["nodes"]) {
    if (node.contains("name")) node["name"] = "Bone." + node["name"].get<std::string>();
    if (node.contains("children"))
      for (Json& child : node["children"]) renumber(child);
  }
  std::reverse(file["nodes"].begin(), file["nodes"].end());
  for (Json& root : file["scenes"][0]["nodes"]) renumber(root);
  for (Json& joint : file["skins"][0]["joints"]) renumber(joint);
  if (file["skins"][0].contains("skeleton")) renumber(file["skins"][0]["skeleton"]);
  for (Json& channel : file["animations"][0]["channels"]) renumber(channel["target"]["node"]);
  file["nodes"].push_back({{"name", "Armature"}, {"children", file["scenes"][0]["nodes"]}});
  file["nodes"].push_back({{"name", "Light"}, {"translation", {1, 2, 3}}});
  file["scenes"][0]["nodes"] = {count, count + 1};
  write_text(path, file.dump());
}

TEST_F(DiscoverBadInput, ARigThatOthersChangedIsFollowedAsBefore) {
  const RiggedMotion arm = test::bending_arm(4);
  const std::string source = array("scans.npz", test::scans_of(arm)), file = rig("arm.gltf", arm);
  const auto followed = [&](const std::string& name) {
    const Finished run = discover(source, {"--rig", file, "--report", out(name)});
    EXPECT_EQ(run.code, 0) << run.err;
    return report(name);
  };
  const Json before = followed("before.json");
  change_as_others_do(file);
  const Json after = followed("after.json");
  ASSERT_EQ(after["bones"].size(), 3u);
  EXPECT_EQ(after["bones"][1]["name"], "Bone.elbow");
  for (size_t j = 0; j < 3; ++j)
    EXPECT_NEAR(after["bones"][j]["turned_deg"].get<double>(), before["bones"][j]["turned_deg"].get<double>(),
                0.5)
        << j;
  for (size_t t = 0; t < before["off_mm"].size(); ++t)
    EXPECT_NEAR(after["off_mm"][t].get<double>(), before["off_mm"][t].get<double>(), 0.5) << t;
}

TEST_F(DiscoverBadInput, RigsThatAreNone) {
  const std::string source = arm("arm.npz", 3), whole = rig("whole.glb", test::bending_arm(3));
  write_text(scratch.path("letter.glb"), "Dear reader, this is no rig.\n");
  write_text(scratch.path("half.glb"), read_bytes(whole).substr(0, 2000));
  write_gltf_character(scratch.path("bare.glb"), character_of_mesh(test::arm_surface(), "bare"));
  for (const char* name : {"letter.glb", "half.glb", "bare.glb", "absent.glb"}) {
    expect_clean_failure(discover(source, {"--rig", scratch.path(name), "--out", out("a.glb")}), name);
    expect_clean_failure(
        run_program({"discover", "--rig", whole, "--perform", scratch.path(name), "--out", out("a.glb")}),
        name);
  }
}

}  // namespace
}  // namespace understudy::tests
