#include <nlohmann/json.hpp>

#include "tests/app/cli_fixture.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class Measuring : public ShippedProgram {
 protected:
  /// One case of the suite, of 24 frames.
  void make_suite(const std::string& suite) {
    test::write_training_folder(scratch.path("data"));
    const Finished run =
        run_program({"cases", scratch.path("data"), "--suite", suite, "--out", scratch.path("cases/" + suite),
                     "--cases", "1", "--frames", "24", "--points", "2000"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.out.find("1 cases"), std::string::npos) << run.out;
  }
};

TEST_F(Measuring, EvalTellsWhereTheErrorLiesAndShowsTheWorstFrames) {
  make_suite("captured");
  const Finished run = run_program({"eval", scratch.path("cases/captured"), "--out", out("r.json"), "--worst",
                                    "2", "--pictures", out("worst"), "--no-offsets", "--restart-every", "2"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json breakdown = Json::parse(read_bytes(out("r.json")))["breakdown"];
  EXPECT_EQ(breakdown["joints"].size(), 22u);
  EXPECT_GT(breakdown["joints"]["left_wrist"]["extraction_mm"], 0);
  EXPECT_TRUE(breakdown["motions"]["sway"].contains("pa_mpjpe_m"));
  EXPECT_TRUE(breakdown["bodies"]["tall"].contains("rot_deg"));
  EXPECT_EQ(breakdown["failures"].size(), 6u);
  EXPECT_EQ(breakdown["confidence"]["bins"].size(), 10u);
  ASSERT_EQ(breakdown["worst"].size(), 2u);
  EXPECT_GE(breakdown["worst"][0]["error_mm"], breakdown["worst"][1]["error_mm"]);
  for (const char* picture : {"worst.png", "worst_01.png", "worst_02.png"})
    EXPECT_TRUE(std::filesystem::exists(out("worst") + "/" + picture)) << picture;
}

TEST_F(Measuring, ABaselineIsEvaluatedInPlaceOfTheExtractor) {
  make_suite("naked");
  const std::string cases = scratch.path("cases/naked");
  const Finished run = run_program({"eval", cases, "--out", out("r.json"), "--baseline", "fit", "--body",
                                    scratch.path("data/body/makehuman_smplformat.npz")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_EQ(report["baseline"], "fit");
  EXPECT_GT(report["mean"]["extraction_mpjpe_mm"], 0);
  std::filesystem::remove_all(scratch.path("out"));
  expect_clean_failure(run_program({"eval", cases, "--baseline", "fit"}), "--body");
}

TEST_F(Measuring, CreaturesNeedNoDataAndHaveABaseline) {
  const Finished made = run_program({"cases", "--suite", "creatures", "--out", scratch.path("cases"),
                                     "--cases", "1", "--frames", "4", "--points", "500"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished run =
      run_program({"eval", scratch.path("cases"), "--baseline", "nodes", "--out", out("r.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_EQ(report["mean"]["found_parts"], 24);
  EXPECT_TRUE(report["breakdown"]["kinds"]["arm"].contains("track_pct"));
  std::filesystem::remove_all(scratch.path("out"));
  expect_clean_failure(run_program({"cases", "--suite", "naked", "--out", out("cases")}),
                       "people and motions");
  expect_clean_failure(
      run_program({"cases", "--suite", "creatures", "--split", "test", "--out", out("cases")}),
      "dev and train");
}

TEST_F(Measuring, ScansAreCleanedAndSkeletonsAreNot) {
  const Finished run = run_program({"measure", scans(), "--out", out("m.json"), "--remove-floor",
                                    "--largest-part", "--crop", "-3,-1,-3,3,3,3"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_GT(Json::parse(read_bytes(out("m.json")))["frames"], 0);
  std::filesystem::remove_all(scratch.path("out"));
  expect_clean_failure(run_program({"measure", scans(), "--crop", "1,1,1,0,2,2"}), "has no inside");
  expect_clean_failure(
      run_program({"measure", US_SOURCE_DIR "/tests/fuzz/corpus/bvh/walk.bvh", "--remove-floor"}),
      "only scans are cleaned");
}

TEST_F(Measuring, ReportWritesAPageAndSaysWhatIsLeftOut) {
  make_suite("extraction");
  write_text(scratch.path("rows.json"),
             R"({"rows": [{"table": "extraction", "name": "ours", "suite": "extraction", "budget": "an hour"},
                          {"table": "extraction", "name": "lost", "suite": "extraction",
                           "extractor_weights": "absent.weights"}]})");
  const std::vector<std::string> command = {
      "report", "--cases", scratch.path("cases"), "--rows", scratch.path("rows.json"), "--out", out("page")};
  const Finished run = run_program(command);
  EXPECT_EQ(run.code, 1) << run.err;  // not all of it is there
  const std::string page = read_bytes(out("page/report.md"));
  EXPECT_NE(page.find("| extraction | ours |"), std::string::npos) << page;
  EXPECT_NE(page.find("an hour"), std::string::npos) << page;
  EXPECT_NE(page.find("left out: lost"), std::string::npos) << page;
  EXPECT_NE(page.find("absent.weights"), std::string::npos) << page;
}

TEST_F(Measuring, GapsAreFilledFromScansAndFromTruePoses) {
  test::write_training_folder(scratch.path("data"));
  const std::string cases = scratch.path("cases/inbetween_5");
  const Finished made = run_program({"cases", scratch.path("data"), "--suite", "inbetween", "--gap", "5",
                                     "--frames", "40", "--points", "2000", "--out", cases});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished run = run_program({"eval", cases, "--out", out("scans.json"), "--fill", "slerp"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json scans = Json::parse(read_bytes(out("scans.json")));
  ASSERT_EQ(run_program({"eval", cases, "--out", out("true.json"), "--oracle", "pose"}).code, 0);
  const Json poses = Json::parse(read_bytes(out("true.json")));
  EXPECT_EQ(scans["fill"], "slerp");
  EXPECT_EQ(poses["fill"], "space");  // the default
  for (const Json& report : {scans, poses}) {
    EXPECT_EQ(report["cases"][0]["frames"], 5);  // 6 to 35 hold one window
    for (const char* key : {"gap_mpjpe_m", "gap_rel_mpjpe_m", "mve_m", "gap_acc", "seam_m", "spread"})
      EXPECT_TRUE(report["mean"].contains(key)) << key;
    EXPECT_FALSE(report["mean"].contains("mpjpe_m"));
  }
  EXPECT_LT(poses["mean"]["gap_mpjpe_m"], 0.05);
  EXPECT_LT(poses["mean"]["gap_mpjpe_m"], scans["mean"]["gap_mpjpe_m"]);
  write_text(scratch.path("rows.json"),
             R"({"rows": [{"table": "inbetween", "name": "hold", "suite": "inbetween_5", "oracle": "pose",
                           "fill": "hold"}]})");
  ASSERT_EQ(run_program({"report", "--cases", scratch.path("cases"), "--rows", scratch.path("rows.json"),
                         "--out", out("page")})
                .code,
            0);
  EXPECT_NE(read_bytes(out("page/report.md")).find("| inbetween_5 | hold |"), std::string::npos);
}

TEST_F(Measuring, WhatIsToComeAndWhatIsSparseAreMadeAndReported) {
  test::write_training_folder(scratch.path("data"));
  test::write_walk_clip(scratch.path("data/motion/b/walk_poses.npz"));
  const auto make = [&](std::vector<std::string> more, const std::string& to) {
    std::vector<std::string> command = {"cases", scratch.path("data"), "--out", scratch.path("cases/" + to)};
    command.insert(command.end(), more.begin(), more.end());
    return run_program(command);
  };
  ASSERT_EQ(make({"--suite", "predict", "--points", "0"}, "predict").code, 0);
  ASSERT_EQ(make({"--suite", "sparse", "--known", "5", "--points", "0", "--cases", "2"}, "sparse").code, 0);
  const Finished scans = make(
      {"--suite", "sparse", "--known", "5", "--points", "2000", "--markers", "16", "--cases", "1"}, "scans");
  ASSERT_EQ(scans.code, 0) << scans.err;
  write_text(scratch.path("rows.json"),
             R"({"rows": [{"table": "predict", "name": "glide", "suite": "predict", "oracle": "pose",
                           "fill": "glide"},
                          {"table": "sparse", "name": "slerp", "suite": "sparse", "oracle": "pose",
                           "fill": "slerp"},
                          {"table": "sparse", "name": "extraction", "suite": "scans", "fill": "hermite"}]})");
  const Finished run = run_program({"report", "--cases", scratch.path("cases"), "--rows",
                                    scratch.path("rows.json"), "--out", out("page")});
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  const std::string page = read_bytes(out("page/report.md"));
  for (const char* row : {"| predict | glide |", "| sparse | slerp |", "| scans | extraction |"})
    EXPECT_NE(page.find(row), std::string::npos) << row << page;
  const Json mean = Json::parse(read_bytes(out("page/rows/sparse_extraction_scans.json")))["mean"];
  for (const char* key : {"mve_m", "gap_mpjpe_m", "chamfer_m"}) EXPECT_GT(mean[key], 0) << key;
  EXPECT_LE(mean["chamfer_m"], mean["mve_m"]);
  std::filesystem::remove_all(scratch.path("out"));
  expect_clean_failure(make({"--suite", "sparse", "--points", "0"}, "none"), "--known");
}

TEST_F(Measuring, ReportRefusesRowsThatItDoesNotKnow) {
  std::filesystem::create_directories(scratch.path("cases"));
  write_text(scratch.path("rows.json"),
             R"({"rows": [{"table": "baselines", "name": "a", "suite": "b", "colour": 1}]})");
  expect_clean_failure(run_program({"report", "--cases", scratch.path("cases"), "--rows",
                                    scratch.path("rows.json"), "--out", out("page")}),
                       "colour");
}

TEST_F(Measuring, MeasureTellsOfAScanWithoutTruth) {
  const Finished run = run_program({"measure", scans(), "--out", out("r.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_EQ(report["frames"], kFrames);
  for (const char* key : {"inside", "bone_drift", "jerk"}) {
    EXPECT_TRUE(report["metrics"].contains(key)) << key;
    EXPECT_TRUE(report["raw"].contains(key)) << key;
  }
  EXPECT_GT(report["metrics"]["inside"], 0.5);
  EXPECT_EQ(report["limbs_seen"]["left leg"], kFrames);
}

TEST_F(Measuring, MeasureJudgesARegisteredCaptureByItsSurface) {
  for (int frame = 0; frame < 4; ++frame) {
    write_target(scratch.path("person.obj"));  // the same vertices in the same order
    std::filesystem::create_directories(scratch.path("capture"));
    std::filesystem::rename(scratch.path("person.obj"),
                            scratch.path("capture/frame_" + std::to_string(frame) + ".obj"));
  }
  const Finished run = run_program({"measure", scratch.path("capture"), "--out", out("m.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("share one topology"), std::string::npos) << run.err;
  const Json report = Json::parse(read_bytes(out("m.json")));
  ASSERT_GE(report["registered"].size(), 12u);
  EXPECT_LT(report["metrics"]["registered_rot_deg"], 6);  // nothing moves, but the order of the vertices
  EXPECT_LT(report["metrics"]["registered_const_mm"], 10);
  const Finished plain =
      run_program({"measure", scratch.path("capture"), "--out", out("m.json"), "--registered", "no"});
  ASSERT_EQ(plain.code, 0) << plain.err;
  EXPECT_FALSE(Json::parse(read_bytes(out("m.json"))).contains("registered"));
  const Finished unknown = run_program({"measure", scratch.path("capture"), "--registered", "perhaps"});
  EXPECT_GT(unknown.code, 0);
  EXPECT_NE(unknown.err.find("--registered"), std::string::npos) << unknown.err;
}

TEST_F(Measuring, MeasureJudgesACharacterAsAScanByItsBones) {
  const std::string adult = US_SOURCE_DIR "/assets/samples/target_adult.glb", moving = out("moving.glb");
  const Finished made = run_program({"retarget", "--source", scans(), "--target", adult, "--out", moving});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished run = run_program({"measure", moving, "--as-scan", "--out", out("m.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json metrics = Json::parse(read_bytes(out("m.json")))["metrics"];
  for (const char* key : {"wrist_deg", "head_deg"}) EXPECT_TRUE(metrics.contains(key)) << key;
  EXPECT_LT(metrics["extraction_limb_mm"], 40);
  EXPECT_LT(metrics["rot_deg"], 20);
}

}  // namespace
}  // namespace understudy::tests
