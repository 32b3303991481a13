// Every subcommand of the shipped program: its help, a good run and a bad one; and what online means.
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/base/file.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/motion/made_motion.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;
using Commands = ShippedProgram;
using Json = nlohmann::json;

TEST_F(Commands, AllHaveHelp) {
  const Finished all = run_program({"--help"});
  EXPECT_EQ(all.code, 0);
  for (const char* name :
       {"retarget", "eval", "train", "sample", "doctor", "bench", "demo", "steps", "study", "sheet"}) {
    EXPECT_NE(all.out.find(name), std::string::npos) << name;
    const Finished help = run_program({name, "--help"});
    EXPECT_EQ(help.code, 0) << name;
    EXPECT_GT(line_count(help.out), 3) << name;
  }
}

TEST_F(Commands, AreRefusedWhenUnknown) {
  const Finished alone = run_program({});
  EXPECT_EQ(alone.code, 2);
  EXPECT_NE(alone.err.find("understudy studio"), std::string::npos) << alone.err;
  EXPECT_EQ(run_program({"dance"}).code, 2);
  EXPECT_EQ(run_program({"retarget", "--source", scans()}).code, 2);  // no target
  EXPECT_EQ(run_program({"bench", "--frames", "-3"}).code, 2);
  EXPECT_EQ(run_program({"eval"}).code, 2);
  EXPECT_EQ(run_program({"train", "juggling", "--data", "x", "--out", "y"}).code, 2);
}

TEST_F(Commands, RetargetWritesAllItIsAskedFor) {
  const Finished run = retarget(
      scans(), {"--out", out("a.glb"), "--report", out("a.json"), "--preview", out("a.png"), "--fps", "25"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_bytes(out("a.glb")).substr(0, 4), "glTF");
  EXPECT_EQ(read_bytes(out("a.png")).substr(1, 3), "PNG");
  const Json report = Json::parse(read_bytes(out("a.json")));
  EXPECT_EQ(report["frames"], kFrames);
  EXPECT_EQ(report["flagged"], 0);
  EXPECT_EQ(report["fps"], 25);
  for (const char* stage : {"read", "extract", "transfer", "deform", "total"})
    EXPECT_GT(report["ms"][stage], 0) << stage;
  for (const char* key : {"bone_drift", "floor_mm", "jerk", "self_penetration", "inside"})
    EXPECT_TRUE(report["metrics"].contains(key)) << key;
  EXPECT_NE(run.err.find("p95"), std::string::npos) << run.err;
  EXPECT_EQ(out_files().size(), 3u);
}

TEST_F(Commands, RetargetGivesAllFiguresAsArrays) {
  ASSERT_EQ(retarget(scans(), {"--out", out("a.npz")}).code, 0);
  const Npz npz = read_npz(out("a.npz"));
  EXPECT_EQ(npz.at("vertices").shape.size(), 3u);
  EXPECT_EQ(npz.at("joints").shape, (std::vector<int64_t>{kFrames, 22, 3}));
  EXPECT_EQ(npz.at("rotations").shape, (std::vector<int64_t>{kFrames, 22, 3, 3}));
  EXPECT_EQ(npz.at("source_joints").shape, (std::vector<int64_t>{kFrames, 22, 3}));
}

TEST_F(Commands, RetargetPerformsASkeletalMotion) {
  const Joints rest = tests::made_joints({});
  std::ofstream(out("walk.bvh")) << tests::made_bvh({}, rest, tests::made_motion(4, rest));
  const Finished run = retarget(out("walk.bvh"), {"--out", out("a.npz")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("22 of 22 joints"), std::string::npos) << run.err;
  EXPECT_EQ(read_npz(out("a.npz")).at("joints").shape, (std::vector<int64_t>{4, 22, 3}));
  const Finished bad = retarget(out("walk.bvh"), {"--clip", "dance", "--out", out("b.npz")});
  EXPECT_EQ(bad.code, 1);
  EXPECT_NE(bad.err.find("walk.bvh: has no animation 'dance'"), std::string::npos) << bad.err;
}

TEST_F(Commands, RetargetGivesTheSameBytesTwice) {
  for (const char* name : {"1.glb", "2.glb", "1.npz", "2.npz"})
    ASSERT_EQ(retarget(scans(), {"--out", out(name)}).code, 0);
  EXPECT_EQ(read_bytes(out("1.glb")), read_bytes(out("2.glb")));
  EXPECT_EQ(read_bytes(out("1.npz")), read_bytes(out("2.npz")));
}

TEST_F(Commands, RetargetNeverLooksAhead) {
  write_scans(scratch.path("cut"), 3);
  ASSERT_EQ(retarget(scans(), {"--out", out("whole.npz")}).code, 0);
  ASSERT_EQ(retarget(scratch.path("cut"), {"--out", out("cut.npz")}).code, 0);
  const Npz whole = read_npz(out("whole.npz")), cut = read_npz(out("cut.npz"));
  for (const char* name : {"vertices", "joints", "rotations", "source_joints"}) {
    const auto &w = whole.at(name).values, &c = cut.at(name).values;
    ASSERT_EQ(c.size() * kFrames, w.size() * 3) << name;
    EXPECT_TRUE(std::equal(c.begin(), c.end(), w.begin())) << name;
  }
}

TEST_F(Commands, FollowFinishesAFrameBeforeTheNextExists) {
  const std::string live = scratch.path("live");
  fs::create_directories(live);
  Program program({"retarget", "--source", live, "--target", target(), "--follow", "--out", out("a.npz")});
  for (int i = 0; i < 4; ++i) {
    write_cloud(live + "/" + frame_name(i), person_points(i));
    ASSERT_TRUE(program.wait_for("frame " + std::to_string(i) + " root")) << program.finish().err;
  }
  write_text(live + "/done", "");
  const Finished run = program.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  ASSERT_EQ(retarget(live, {"--out", out("b.npz")}).code, 0);  // and gives what all frames at once give
  EXPECT_EQ(read_npz(out("a.npz")).at("joints").values, read_npz(out("b.npz")).at("joints").values);
}

/// A case whose truth says that everything stays in the T-pose.
class Eval : public ShippedProgram {
 protected:
  std::string make_case(const std::string& name, bool with_target) {
    const std::string folder = scratch.path("cases/" + name);
    write_scans(folder + "/source", kFrames);
    Json json = {{"fps", 30}, {"source", "source"}, {"truth", "truth.npz"}, {"tags", {"test"}}};
    if (with_target) {
      fs::copy(target(), folder + "/target.obj");
      json["target"] = "target.obj";
    }
    write_text(folder + "/case.json", json.dump());
    NpyArray joints{{kFrames, 22, 3}, std::vector<float>(kFrames * 66), {}};
    const Joints standing = builtin_joints();
    for (size_t i = 0; i < joints.values.size(); ++i) joints.values[i] = standing.data()[i % 66];
    NpyArray rotations{{kFrames, 22, 3, 3}, std::vector<float>(kFrames * 198), {}};
    for (size_t i = 0; i < rotations.values.size(); ++i) rotations.values[i] = i % 9 % 4 == 0;
    NpyArray rest{{22, 3}, {joints.values.begin(), joints.values.begin() + 66}, {}};
    write_npz(
        folder + "/truth.npz",
        {{"joints", joints}, {"source_joints", joints}, {"rotations", rotations}, {"target_joints", rest}});
    return folder;
  }
};

TEST_F(Eval, EvaluatesEachCaseAndTheMean) {
  make_case("a", true);
  make_case("b", false);
  const Finished run = run_program({"eval", scratch.path("cases"), "--out", out("r.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_FALSE(report["program"].get<std::string>().empty());
  EXPECT_NE(report["weights"].get<std::string>().find("skeleton.weights:"), std::string::npos);
  ASSERT_EQ(report["cases"].size(), 2u);
  const Json& a = report["cases"][0];
  EXPECT_EQ(a["name"], "a");
  EXPECT_EQ(a["frames"], kFrames);
  EXPECT_EQ(a["flagged"], 0);
  for (const char* key : {"mpjpe_m", "pa_mpjpe_m", "acc", "pa_acc", "rot_deg", "head_deg", "wrist_deg",
                          "foot_deg", "extraction_mpjpe_mm", "extraction_swap_rate", "extraction_flip_rate"})
    EXPECT_TRUE(a["metrics"].contains(key)) << key;
  EXPECT_FALSE(report["cases"][1]["metrics"].contains("mpjpe_m"));  // no target: only the extraction
  EXPECT_TRUE(report["cases"][1]["metrics"].contains("extraction_mpjpe_mm"));
  EXPECT_EQ(report["mean"]["mpjpe_m"], a["metrics"]["mpjpe_m"]);
  for (const char* key : {"ms", "ms_p95"}) EXPECT_GT(report[key]["total"], 0) << key;
}

TEST_F(Eval, GoesOnAfterACaseThatFails) {
  make_case("good", true);
  fs::remove_all(make_case("bad", true) + "/source");
  const Finished run = run_program({"eval", scratch.path("cases"), "--out", out("r.json")});
  EXPECT_EQ(run.code, 1);
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_TRUE(report["cases"][0].contains("error"));
  EXPECT_FALSE(report["cases"][0].contains("metrics"));
  EXPECT_TRUE(report["cases"][1].contains("metrics"));
}

TEST_F(Eval, TheSkeletonOracleIsBelieved) {
  make_case("a", true);
  ASSERT_EQ(run_program({"eval", scratch.path("cases"), "--out", out("r.json"), "--oracle", "skeleton"}).code,
            0);
  const Json metrics = Json::parse(read_bytes(out("r.json")))["mean"];
  EXPECT_NEAR(metrics["extraction_raw_mpjpe_mm"], 0, 1e-6);
}

TEST_F(Eval, ThePoseOracleLeavesOnlyTheSurfaceToTheMethod) {
  make_case("a", true);
  ASSERT_EQ(run_program({"eval", scratch.path("cases"), "--out", out("r.json"), "--oracle", "pose"}).code, 0);
  const Json metrics = Json::parse(read_bytes(out("r.json")))["mean"];
  EXPECT_NEAR(metrics["mpjpe_m"], 0, 1e-5);
  EXPECT_NEAR(metrics["rot_deg"], 0, 1e-3);
  EXPECT_FALSE(metrics.contains("extraction_mpjpe_mm"));
}

TEST_F(Eval, RefusesAFolderWithoutCases) {
  expect_clean_failure(run_program({"eval", scratch.path(""), "--out", out("r.json")}), "case.json");
}

TEST_F(Commands, TrainTrainsAndResumes) {
  test::write_training_folder(scratch.path("data"));
  const std::vector<std::string> train = {"train",    "skeleton",       "--data",  scratch.path("data"),
                                          "--out",    out("s.weights"), "--batch", "4",
                                          "--samples"};
  auto first = train, second = train;
  first.push_back("8");
  second.push_back("16");
  Finished run = run_program(first);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_GT(fs::file_size(out("s.weights")), 10000u);
  EXPECT_TRUE(fs::exists(out("s.weights.csv")));
  run = run_program(second);
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST_F(Commands, TrainLearnsToReadLengthsOffPoses) {
  test::write_training_folder(scratch.path("data"));
  const Finished run =
      run_program({"train", "proportions", "--data", scratch.path("data"), "--out",
                   out("proportions.weights"), "--batch", "16", "--samples", "32", "--threads", "1"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("true_ratios_odd"), std::string::npos) << run.err;  // what it is measured against
  EXPECT_LT(fs::file_size(out("proportions.weights")), 1u << 20);
}

TEST_F(Commands, TrainLeavesOutALossOfPaper3ByTheSameSwitchInBothNetworks) {
  test::write_training_folder(scratch.path("data"));
  const auto trained = [&](const std::vector<std::string>& more) {
    const std::string file = out("trained.weights");
    std::vector<std::string> words = {"train", more[0],   "--data", scratch.path("data"), "--out",
                                      file,    "--batch", "1",      "--samples",          "3"};
    words.insert(words.end(), more.begin() + 1, more.end());
    const Finished run = run_program(words);
    EXPECT_EQ(run.code, 0) << run.err;
    const std::string bytes = read_file(file);
    fs::remove(file), fs::remove(file + ".checkpoint"), fs::remove(file + ".csv");
    return bytes.substr(bytes.size() - 10000);  // the header tells the seconds
  };
  for (const std::vector<std::string>& network :
       {std::vector<std::string>{"marionette-slots"},
        std::vector<std::string>{"marionette-paper", "--width", "16"}}) {
    const std::string all = trained(network);
    EXPECT_TRUE(all == trained(network)) << network[0] << ": one seed, one training";
    for (const char* left_out : {"--no-vol", "--no-traj", "--no-local", "--no-time"}) {
      std::vector<std::string> without = network;
      without.push_back(left_out);
      EXPECT_FALSE(all == trained(without)) << network[0] << " " << left_out;
    }
  }
  EXPECT_EQ(run_program({"train", "marionette-slots", "--no-sep", "--data", "x", "--out", "y"}).code, 2);
}

TEST_F(Commands, TrainWantsData) {
  expect_clean_failure(run_program({"train", "skeleton", "--samples", "1", "--data", scratch.path("absent"),
                                    "--out", out("s.weights")}),
                       "absent");
  expect_clean_failure(
      run_program({"train", "proportions", "--data", scratch.path("absent"), "--out", out("p.weights")}),
      "absent");
  expect_clean_failure(
      run_program({"train", "skeleton", "--data", scratch.path("absent"), "--out", out("s.weights")}),
      "--minutes");
}

TEST_F(Commands, SampleWritesScansAndTargetsThatRetargetTakes) {
  const Finished run = run_program({"sample", out("samples")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(fs::is_directory(out("samples/scan")));
  EXPECT_TRUE(fs::exists(out("samples/target_adult.glb")));
}

TEST_F(Commands, SampleRefusesAFolderThatCannotBeMade) {
  expect_clean_failure(run_program({"sample", "/proc/samples"}), "/proc/samples");
}

TEST_F(Commands, DoctorTellsWhatIsThere) {
  const Finished run = run_program({"doctor"});
  EXPECT_EQ(run.code, 0) << run.out;
  for (const char* word : {"kernels", "torch", "BLAS", "threads", "weights", "OpenGL"})
    EXPECT_NE(run.out.find(word), std::string::npos) << word;
}

TEST_F(Commands, DoctorTellsWhatIsMissing) {
  const Finished run = run_program({"doctor", "--weights", scratch.path("")});
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.out.find("MISSING"), std::string::npos) << run.out;
}

TEST_F(Commands, BenchMeasures) {
  const Finished run = run_program({"bench", "--source", scans(), "--target", target(), "--frames", "12"});
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* word : {"p95", "frames/s", "start-up", "MB at most", "MFLOP", "peak"})
    EXPECT_NE(run.out.find(word), std::string::npos) << word << '\n' << run.out;
}

TEST_F(Commands, BenchWantsASource) {
  expect_clean_failure(run_program({"bench", "--source", scratch.path("absent"), "--target", target()}),
                       "absent");
}

}  // namespace
}  // namespace understudy::tests
