// `understudy style`, and --style, --tempo and --delay of `retarget` and `export`.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/character/read_character.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/motion/clip.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class Styling : public ShippedProgram {
 protected:
  void SetUp() override { write_walk(walk()); }
  std::string walk() const { return scratch.path("walk.npz"); }
  Finished style(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"style"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  Finished retarget(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"retarget", "--source", walk(), "--target", target()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  /// Two manners of moving, two clips each, in the folders `walk` and `dance`.
  void write_manners() const {
    for (const char* const motion : {"walk", "dance"}) {
      std::filesystem::create_directories(scratch.path(motion));
      for (int i = 0; i < 2; ++i) {
        WalkOptions part;
        part.motion = motion, part.first = 20 * i, part.last = 90 + 20 * i;
        write_walk(scratch.path(motion) + "/" + std::to_string(i) + ".npz", part);
      }
    }
  }
  /// Frames of a GLB's only animation.
  int64_t frames_of(const std::string& file) const {
    const Character character = read_character(file);
    return clip_times(character, 0, 30).count;
  }
  /// It fails with one sentence that has these words, and leaves nothing behind.
  void expect_refused(const Finished& done, const std::string& words, const std::string& file) {
    EXPECT_NE(done.code, 0) << done.out;
    EXPECT_NE(done.err.find(words), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(file));
  }
};

TEST_F(Styling, AllStylesAreListedWithTheirLicences) {
  const Finished done = style({"--list"});
  ASSERT_EQ(done.code, 0) << done.err;
  for (const char* const name : {"child", "old", "tired", "happy"})
    EXPECT_NE(done.out.find(name), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("Licence: MIT"), std::string::npos) << done.out;
}

TEST_F(Styling, AWalkIsWrittenInEachFormatAndReported) {
  for (const char* const file : {"a.bvh", "a.npz", "a.glb"}) {
    const Finished done = style({walk(), "--to", "child", "--out", out(file), "--report", out("r.json")});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("150 frames"), std::string::npos) << done.out;
  }
  const Json report = Json::parse(read_bytes(out("r.json")));
  EXPECT_EQ(report["style"]["name"], "child");
  EXPECT_EQ(report["style"]["licence"], "MIT");
  EXPECT_FALSE(report["style"]["non_commercial"]);
  EXPECT_GT(report["figures"]["body_sway_deg"], report["source_figures"]["body_sway_deg"]);
  EXPECT_LT(report["stance_slide_ratio"], 1.5);
  EXPECT_EQ(read_npz(out("a.npz")).at("poses").shape[0], 150);
  EXPECT_EQ(frames_of(out("a.glb")), 150);
  const Finished again = style({out("a.bvh"), "--to", "old", "--out", out("b.bvh")});
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST_F(Styling, StrengthNothingIsNoStyleToTheByte) {
  ASSERT_EQ(retarget({"--out", out("plain.bvh")}).code, 0);
  ASSERT_EQ(retarget({"--style", "old", "--style-strength", "0", "--out", out("none.bvh")}).code, 0);
  ASSERT_EQ(retarget({"--style", "old", "--out", out("old.bvh")}).code, 0);
  EXPECT_EQ(read_bytes(out("plain.bvh")), read_bytes(out("none.bvh")));
  EXPECT_NE(read_bytes(out("plain.bvh")), read_bytes(out("old.bvh")));
}

TEST_F(Styling, TheTempoChangesTheLengthAndADelayKeepsIt) {
  ASSERT_EQ(retarget({"--tempo", "0.5", "--out", out("half.glb"), "--report", out("half.json")}).code, 0);
  EXPECT_NEAR(static_cast<double>(frames_of(out("half.glb"))), 76, 1);
  EXPECT_NEAR(Json::parse(read_bytes(out("half.json")))["length"].get<double>(), 0.5, 1e-6);
  const Finished done = run_program(
      {"export", "--source", walk(), "--target", target(), "--tempo", "2", "--out", out("twice.glb")});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NEAR(static_cast<double>(frames_of(out("twice.glb"))), 299, 1);
  ASSERT_EQ(
      retarget({"--tempo", "0.7", "--delay", "0.5", "--out", out("live.glb"), "--report", out("live.json")})
          .code,
      0);
  EXPECT_GE(frames_of(out("live.glb")), 150);
  EXPECT_LE(frames_of(out("live.glb")), 166) << "the reserve alone comes after";
  EXPECT_EQ(Json::parse(read_bytes(out("live.json")))["length"], 1);
}

TEST_F(Styling, AStylesLicenceGoesIntoTheFile) {
  Json mine = Json::parse(read_bytes(US_SOURCE_DIR "/assets/styles/happy.json"));
  mine["licence"] = "CC BY-NC 4.0";
  mine["attribution"] = "(c) Somebody";
  std::ofstream(scratch.path("mine.json")) << mine.dump();
  ASSERT_EQ(retarget({"--style", scratch.path("mine.json"), "--out", out("mine.glb")}).code, 0);
  const std::string rights = "CC BY-NC 4.0 (non-commercial), (c) Somebody";
  EXPECT_NE(read_bytes(out("mine.glb")).find(rights), std::string::npos);
  ASSERT_EQ(style({walk(), "--to", scratch.path("mine.json"), "--out", out("own.glb")}).code, 0);
  EXPECT_NE(read_bytes(out("own.glb")).find(rights), std::string::npos);
  const Finished told = style({walk(), "--to", scratch.path("mine.json"), "--out", out("own.bvh")});
  EXPECT_NE(told.err.find("no place for its rights: Performed in the style Happy, " + rights),
            std::string::npos)
      << told.err;
  EXPECT_EQ(style({walk(), "--to", "happy", "--out", out("free.bvh")}).err.find("rights"), std::string::npos);
}

TEST_F(Styling, OneIsTaughtFromTwoFoldersAndPerformedIn) {
  write_manners();
  const auto teach = [&](const std::string& to, const std::string& file) {
    return run_program({"train", "style", "--data", scratch.path(""), "--from", "walk", "--to", to,
                        "--licence", "MIT", "--out", file});
  };
  const Finished done = teach("dance", out("dance.json"));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("fitted to 2 recordings of dance and 2 of walk"), std::string::npos) << done.out;
  EXPECT_EQ(Json::parse(read_bytes(out("dance.json")))["made_from"], "recordings of dance and walk");
  const Finished styled = style({walk(), "--to", out("dance.json"), "--out", out("styled.bvh")});
  EXPECT_EQ(styled.code, 0) << styled.err;
  expect_refused(teach("walk", out("same.json")), "is the other manner again", out("same.json"));
  expect_refused(teach("run", out("none.json")), "no such folder of recordings", out("none.json"));
}

TEST_F(Styling, AStyleIsJudgedOnCasesOfTheSuite) {
  write_manners();
  const std::string data = scratch.path(""), cases = scratch.path("cases"), judge = out("judge.weights");
  ASSERT_EQ(run_program({"train", "style", "--data", data, "--from", "walk", "--to", "dance", "--licence",
                         "MIT", "--out", out("dance.json")})
                .code,
            0);
  std::filesystem::create_directories(scratch.path("manners"));
  for (const char* const motion : {"walk", "dance"})
    std::filesystem::copy(scratch.path(motion), scratch.path("manners") + "/" + motion);
  const Finished trained = run_program({"train", "style-judge", "--data", scratch.path("manners"),
                                        "--licence", "MIT", "--samples", "3200", "--out", judge});
  ASSERT_EQ(trained.code, 0) << trained.err;
  const Finished made =
      run_program({"cases", data, "--suite", "style", "--from", "walk", "--to", "dance", "--out", cases});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("4 cases"), std::string::npos) << made.out;
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"eval", cases, "--judge", judge, "--out", out("r.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished done = run_program(arguments);
    EXPECT_EQ(done.code, 0) << done.err << done.out;
    return Json::parse(read_bytes(out("r.json")))["style_figures"]["figures"];
  };
  const Json plain = figures({});
  EXPECT_EQ(plain["real_style_share"]["mean"], 100) << plain.dump();
  EXPECT_EQ(plain["style_share"]["mean"], 0) << plain.dump();
  EXPECT_EQ(plain["jerk_ratio"]["mean"], 1);
  EXPECT_LT(plain["dtw_deg"]["mean"], 0.1);
  const Json styled = figures(
      {"--style", out("dance.json"), "--style-back", out("dance.json"), "--pictures", out("pictures")});
  EXPECT_TRUE(std::filesystem::exists(out("pictures/style_figures.png")));
  EXPECT_EQ(styled["style_share"]["mean"], 100) << styled.dump();
  EXPECT_GT(styled["dtw_deg"]["mean"], 3);
  EXPECT_TRUE(styled.contains("cycle_share"));
  const Json adain = figures({"--baseline", "adain", "--data", data});
  EXPECT_EQ(adain["style_share"]["mean"], 100) << adain.dump();
  EXPECT_NE(run_program({"eval", cases, "--baseline", "adain"}).code, 0) << "--data is missing";
  EXPECT_NE(run_program({"eval", cases, "--judge", walk()}).code, 0) << "a clip is no judge";
  EXPECT_NE(run_program({"cases", data, "--suite", "style", "--from", "walk", "--out", cases}).code, 0);
}

TEST_F(Styling, BadInputIsRefusedInASentence) {
  const std::string file = out("x.bvh");
  expect_refused(style({walk(), "--to", "chld", "--out", file}), "there is no style 'chld'", file);
  expect_refused(style({walk(), "--to", "child"}), "--out is required", file);
  expect_refused(style({walk(), "--out", file}), "--to is required", file);
  expect_refused(style({"--to", "child", "--out", file}), "MOTION is required", file);
  expect_refused(style({walk(), "--to", "child", "--out", out("x.fbx")}), ".bvh, .npz or .glb", out("x.fbx"));
  expect_refused(style({walk(), "--to", "child", "--strength", "3", "--out", file}), "--strength", file);
  expect_refused(style({walk(), "--tempo", "body", "--out", file}), "--legs", file);
  expect_refused(retarget({"--tempo", "fast", "--out", file}), "--tempo fast: must be body, off", file);
  expect_refused(retarget({"--tempo", "0", "--out", file}), "--tempo 0: must be body, off", file);
  expect_refused(retarget({"--tempo", "-1", "--out", file}), "--tempo", file);
  expect_refused(retarget({"--delay", "1", "--out", file}), "--delay is of a tempo", file);
  expect_refused(style({scratch.path("absent.bvh"), "--to", "child", "--out", file}), "absent.bvh", file);
  std::ofstream(scratch.path("bad.json")) << "{\"understudy_style\": 9, \"joints\": \"SMPL 22\"}";
  expect_refused(style({walk(), "--to", scratch.path("bad.json"), "--out", file}),
                 "bad.json: is of version 9", file);
  std::ofstream(scratch.path("bad.weights")) << "nothing";
  expect_refused(style({walk(), "--to", scratch.path("bad.weights"), "--out", file}),
                 "bad.weights: not a weights", file);
}

}  // namespace
}  // namespace understudy::tests
