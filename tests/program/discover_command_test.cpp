#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/character/read_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/motion/made_motion.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class DiscoverCommand : public ShippedProgram {
 protected:
  static constexpr int kScans = 14;
  /// Scans of a desk lamp that moves.
  std::string lamp() {
    const Finished run =
        run_program({"cases", "--suite", "creatures", "--out", scratch.path("cases"), "--cases", "7",
                     "--frames", std::to_string(kScans), "--points", "3000"});
    EXPECT_EQ(run.code, 0) << run.err;
    for (const auto& folder : std::filesystem::directory_iterator(scratch.path("cases")))
      if (folder.path().filename().string().rfind("lamp", 0) == 0) return folder.path().string() + "/source";
    ADD_FAILURE() << run.out;
    return {};
  }
};

TEST_F(DiscoverCommand, ALampsBonesAreFoundAndItsFileOpensAgain) {
  const Finished run = run_program({"discover", "--source", lamp(), "--out", out("rig.glb"), "--result",
                                    out("r.npz"), "--report", out("r.json"), "--preview", out("p.png")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_EQ(report["frames"], kScans);
  EXPECT_EQ(report["complete"], true);
  const size_t bones = report["bones"].size();
  EXPECT_GE(bones, 2u);
  EXPECT_NE(run.out.find(std::to_string(bones) + " bones"), std::string::npos) << run.out;
  double most = 0;
  for (const Json& bone : report["bones"]) {
    most = std::max(most, bone["turned_deg"].get<double>());
    EXPECT_GT(bone["seen_share"].get<double>(), 0.5) << bone << ": its scans hide nothing";
    EXPECT_LE(bone["seen_share"].get<double>(), 1);
  }
  EXPECT_GT(most, 5);
  const RiggedMotion read = from_character(read_character(out("rig.glb")), 0, 30);
  EXPECT_EQ(read.rig.joints.size(), bones);
  EXPECT_EQ(read.motion.poses.size(), static_cast<size_t>(kScans));
  EXPECT_GT(std::filesystem::file_size(out("p.png")), 10000u);
  EXPECT_GT(std::filesystem::file_size(out("r.npz")), 10000u);
}

TEST_F(DiscoverCommand, OfCroppedScansTheBonesOfWhatIsLeftAreFound) {
  const std::string scans = lamp();
  const auto height = [&](const std::string& high) {
    const Finished run = run_program(
        {"discover", "--source", scans, "--crop", "-9", "-9", "-9", "9", high, "9", "--out", out("rig.glb")});
    EXPECT_EQ(run.code, 0) << run.err;
    return from_character(read_character(out("rig.glb")), 0, 30).rig.surface.vertices.col(1).maxCoeff();
  };
  EXPECT_GT(height("9"), 0.25f);
  EXPECT_LT(height("0.15"), 0.2f);
}

TEST_F(DiscoverCommand, ItsMotionAloneIsBvh) {
  const Finished run = run_program({"discover", "--source", lamp(), "--out", out("rig.bvh")});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string text = read_bytes(out("rig.bvh"));
  EXPECT_NE(text.find("ROOT bone_0\n"), std::string::npos) << text.substr(0, 200);
  EXPECT_NE(text.find("JOINT bone_1\n"), std::string::npos) << text.substr(0, 200);
  const size_t frames = text.find("Frames:");
  ASSERT_NE(frames, std::string::npos);
  EXPECT_EQ(std::stoi(text.substr(frames + 7)), kScans);
}

TEST_F(DiscoverCommand, AFoundRigIsFollowedInScansAndPerformedByAnother) {
  const std::string scans = lamp();
  ASSERT_EQ(run_program({"discover", "--source", scans, "--out", out("rig.glb")}).code, 0);
  const Finished followed = run_program({"discover", "--rig", out("rig.glb"), "--source", scans, "--out",
                                         out("again.glb"), "--report", out("f.json")});
  ASSERT_EQ(followed.code, 0) << followed.err;
  const Json report = Json::parse(read_bytes(out("f.json")));
  EXPECT_EQ(report["frames"], kScans);
  EXPECT_GT(report["ms"].get<double>(), 0);
  const Finished performed = run_program({"discover", "--rig", out("rig.glb"), "--perform", out("again.glb"),
                                          "--matches", out("m.json"), "--out", out("performed.glb"),
                                          "--report", out("p.json"), "--preview", out("p.png")});
  ASSERT_EQ(performed.code, 0) << performed.err;
  const Json told = Json::parse(read_bytes(out("p.json")));
  double most = 0;
  for (const Json& bone : told["bones"]) {
    most = std::max(most, bone["turned_deg"].get<double>());
    EXPECT_TRUE(bone["off_mm"].is_null()) << "it was laid on no scans";
  }
  EXPECT_GT(most, 5);
  const RiggedMotion read = from_character(read_character(out("performed.glb")), 0, 30);
  EXPECT_EQ(read.motion.poses.size(), static_cast<size_t>(kScans));
  Json matches = Json::parse(read_bytes(out("m.json")));
  for (const Json& bone : matches["bones"]) EXPECT_EQ(bone["bone"], bone["partner"]);  // the same body
  matches["bones"][1]["partner"] = "nobody";
  std::ofstream(out("m.json")) << matches.dump();
  const Finished refused = run_program({"discover", "--rig", out("rig.glb"), "--perform", out("again.glb"),
                                        "--matches", out("m.json"), "--out", out("no.glb")});
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.err.find("has no bone \"nobody\""), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(out("no.glb")));
}

TEST_F(DiscoverCommand, SaysWhatItCannotDo) {
  expect_clean_failure(run_program({"discover", "--out", out("rig.glb")}), "--source");
  expect_clean_failure(
      run_program({"discover", "--source", scans(), "--matches", out("m.json"), "--out", out("r.glb")}),
      "--matches is of --perform");
  expect_clean_failure(
      run_program({"discover", "--rig", scratch.path("rig.obj"), "--source", scans(), "--out", out("r.glb")}),
      ".glb or .gltf");
  expect_clean_failure(run_program({"discover", "--source", scans()}), "nothing is to be written");
  expect_clean_failure(run_program({"discover", "--source", scans(), "--out", out("rig.obj")}),
                       ".glb, .gltf or .bvh");
  const auto by = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"discover", "--source", scans(), "--out", out("r.glb")});
    return run_program(words);
  };
  expect_clean_failure(by({"--method", "slots"}), "--kind");
  expect_clean_failure(by({"--kind", "hand"}), "--kind and --weights are of --method slots");
  expect_clean_failure(by({"--method", "slots", "--kind", "teapot"}), "not 'teapot'");
  expect_clean_failure(by({"--method", "slots", "--kind", "hand", "--parts", "4"}), "--parts does not apply");
  expect_clean_failure(by({"--method", "slots", "--kind", "hand", "--weights", scratch.path("none")}),
                       "none/marionette_slots_hand.weights");
  expect_clean_failure(run_program({"discover", "--source", scratch.path("absent"), "--out", out("rig.glb")}),
                       "absent");
  const Joints rest = made_joints({});
  std::ofstream(scratch.path("walk.bvh")) << made_bvh({}, rest, made_motion(4, rest));
  expect_clean_failure(
      run_program({"discover", "--source", scratch.path("walk.bvh"), "--out", out("rig.glb")}),
      "has its bones already");
  std::filesystem::create_directories(scratch.path("one"));
  std::filesystem::copy_file(std::filesystem::directory_iterator(scans())->path(),
                             scratch.path("one/frame_0.ply"));
  expect_clean_failure(run_program({"discover", "--source", scratch.path("one"), "--out", out("rig.glb")}),
                       "two frames");
}

}  // namespace
}  // namespace understudy::tests
