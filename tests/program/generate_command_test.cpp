// `understudy generate`: more of a rig's motion, and what it says where there is nothing to make it of.
#include <signal.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/run/rig_performance.hpp"
#include "retarget/base/index.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/creature/creature.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class Generate : public ShippedProgram {
 protected:
  void SetUp() override {
    dog_.rig = make_creature(CreatureKind::Quadruped, 2);
    dog_.motion = creature_motion(CreatureKind::Quadruped, dog_.rig, 0, 60, 30, 2);
    write_gltf_character(path(), to_character(dog_));
  }
  std::string path() const { return scratch.path("dog.glb"); }
  Finished generate(std::vector<std::string> more, const std::string& rig = "") {
    std::vector<std::string> arguments = {"generate", "--rig", rig.empty() ? path() : rig};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  RiggedMotion dog_;
};

TEST_F(Generate, WritesTheSameRigWithAClipForEachSeed) {
  const Finished run = generate({"--frames", "40", "--count", "3", "--seed", "5", "--out", out("a.glb"),
                                 "--report", out("a.json"), "--preview", out("a.png")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Character made = read_character(out("a.glb"));
  ASSERT_EQ(made.animations.size(), 3u);
  EXPECT_EQ(made.animations[0].name, "motion 5");
  EXPECT_NEAR(static_cast<double>(made.animations[2].duration()), 39.0 / 30, 1e-4);
  EXPECT_EQ(made.skins[0].joints.size(), dog_.rig.joints.size());
  EXPECT_EQ(made.vertex_count(), dog_.rig.surface.vertices.rows());
  const Json report = Json::parse(read_bytes(out("a.json")));
  ASSERT_EQ(report["motions"].size(), 3u);
  EXPECT_GT(report["motions"][0]["nearest_m"].get<double>(), 0.001);
  EXPECT_GT(read_bytes(out("a.png")).size(), 10000u);
}

TEST_F(Generate, BetweenTwoFramesOfTheClip) {
  for (const std::string engine : {"match", "slerp", "lerp"}) {
    const std::string file = out(engine + ".glb");
    const Finished run =
        generate({"--between", "10", "30", "--frames", "25", "--engine", engine, "--out", file});
    ASSERT_EQ(run.code, 0) << run.err;
    const RiggedMotion made = app::read_rig(file);
    ASSERT_EQ(ssize(made.motion.poses), 25);
    EXPECT_LT((made.motion.poses[0].root - dog_.motion.poses[10].root).norm(), 1e-4f) << engine;
    EXPECT_LT((made.motion.poses[24].root - dog_.motion.poses[30].root).norm(), 1e-4f) << engine;
  }
}

TEST_F(Generate, ALoopAndAMotionAlone) {
  EXPECT_EQ(generate({"--loop", "--frames", "30", "--out", out("a.bvh")}).code, 0);
  const std::string file = read_bytes(out("a.bvh"));
  const size_t frames = file.find("Frames:");
  ASSERT_NE(frames, std::string::npos);
  EXPECT_EQ(std::stoi(file.substr(frames + 7)), 30);
}

TEST_F(Generate, KeysFarApartAreMetAndToldOf) {
  const Finished run = generate({"--between", "0", "59", "--frames", "4", "--out", out("a.glb")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("m apart: in 4 frames"), std::string::npos) << run.err;
}

TEST_F(Generate, ARigWithoutAClip) {
  RiggedMotion still = dog_;
  still.motion.poses.clear();
  write_gltf_character(scratch.path("still.glb"), to_character(still));
  expect_clean_failure(generate({"--out", out("a.glb")}, scratch.path("still.glb")),
                       "still.glb: has no motion, one pose alone");
}

TEST_F(Generate, AClipOfOneFrame) {
  RiggedMotion one = dog_;
  one.motion.poses.resize(1);
  write_gltf_character(scratch.path("one.glb"), to_character(one));
  expect_clean_failure(generate({"--out", out("a.glb")}, scratch.path("one.glb")),
                       "one.glb: has no motion, one pose alone");
}

TEST_F(Generate, FramesThatTheClipDoesNotHave) {
  expect_clean_failure(generate({"--between", "5", "60", "--out", out("a.glb")}),
                       "dog.glb: has frames 0 to 59, so none 60");
  expect_clean_failure(generate({"--between", "-1", "6", "--out", out("a.glb")}), "so none -1");
}

TEST_F(Generate, TooFewOrTooManyFrames) {
  expect_clean_failure(generate({"--frames", "1", "--out", out("a.glb")}), "2 to 10000 frames, not 1");
  expect_clean_failure(generate({"--frames", "100000", "--out", out("a.glb")}), "not 100000");
  expect_clean_failure(generate({"--count", "0", "--out", out("a.glb")}), "1 to 100 motions");
}

TEST_F(Generate, EnginesThatDoNotFit) {
  expect_clean_failure(generate({"--engine", "slerp", "--out", out("a.glb")}), "between two frames alone");
  expect_clean_failure(generate({"--engine", "none", "--out", out("a.glb")}),
                       "only match, vrnn, slerp, lerp");
}

TEST_F(Generate, WeightsThatAreMissing) {
  const std::string empty = scratch.path("empty");
  std::filesystem::create_directories(empty);
  expect_clean_failure(generate({"--engine", "vrnn", "--weights", empty, "--out", out("a.glb")}),
                       "empty: has no weights of how bodies move");
}

TEST_F(Generate, ARigUnlikeTheKind) {
  const std::string weights = scratch.path("other.weights");
  const Json header = {{"kind", "marionette-dynamics"},
                       {"version", 2},
                       {"numbers", Json::object()},
                       {"texts", {{"kind", "hand"}, {"bones", "palm:;thumb:palm;"}}},
                       {"tensors", Json::array()}};
  const std::string text = header.dump();
  const auto size = static_cast<uint32_t>(text.size());
  std::ofstream file(weights, std::ios::binary);
  file << "USWEIGHT";
  file.write(reinterpret_cast<const char*>(&size), sizeof size);
  file << text;
  file.close();
  expect_clean_failure(generate({"--engine", "vrnn", "--weights", weights, "--out", out("a.glb")}),
                       "dog.glb: its bones are not those of the kinds that a network knows (hand)");
}

TEST_F(Generate, ChoicesThatDoNotApplyAreRefused) {
  expect_clean_failure(generate({"--sampling", "paper", "--out", out("a.glb")}),
                       "--sampling paper is of --engine vrnn with --between");
  const Finished below = generate({"--seed", "-1", "--out", out("a.glb")});
  EXPECT_NE(below.code, 0);
  EXPECT_NE(below.err.find("--seed"), std::string::npos) << below.err;
}

TEST_F(Generate, CtrlCWritesNothing) {
  Program program({"generate", "--rig", path(), "--frames", "2000", "--count", "100", "--out", out("a.glb")});
  ASSERT_TRUE(program.wait_for("making motions"));
  program.send(SIGINT);
  expect_clean_failure(program.finish(), "nothing was written");
}

}  // namespace
}  // namespace understudy::tests
