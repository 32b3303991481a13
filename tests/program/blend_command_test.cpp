// `understudy blend`: what lies between motions, a clip for each step, and said to be made.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "retarget/character/read_character.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class Blending : public ShippedProgram {
 protected:
  void SetUp() override {
    WalkOptions fast;
    fast.fps = 50;
    write_walk(scratch.path("walk.npz"));
    write_walk(scratch.path("run.npz"), fast);
  }
  std::string walk() const { return scratch.path("walk.npz"); }
  std::string run() const { return scratch.path("run.npz"); }
  Finished blend(const std::vector<std::string>& motions, const std::vector<std::string>& more = {},
                 const std::string& file = "blend.glb") {
    std::vector<std::string> arguments = {"blend"};
    arguments.insert(arguments.end(), motions.begin(), motions.end());
    for (const std::string& word : {std::string("--target"), target(), std::string("--out"), out(file),
                                    std::string("--coder"), std::string("plain")})
      arguments.push_back(word);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(Blending, AClipForEachStepIsWrittenAndToldToBeMade) {
  const Finished done = blend(
      {walk(), run()}, {"--steps", "3", "--report", out("report.json"), "--preview", out("ghosts.png")});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("3 clips, all of them made"), std::string::npos) << done.out;
  EXPECT_EQ(read_bytes(out("ghosts.png")).substr(1, 3), "PNG");
  const Character character = read_character(out("blend.glb"));
  ASSERT_EQ(character.animations.size(), 3u);
  const char* const names[] = {"0.00 run", "0.50 run", "1.00 run"};
  const Json report = Json::parse(read_bytes(out("report.json")));
  ASSERT_EQ(report["steps"].size(), 3u);
  ASSERT_EQ(report["parts"].size(), 2u);
  EXPECT_EQ(report["parts"][1]["file"], run());
  double before = 100, skate[3];
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(character.animations[i].name, names[i]);
    const Json& step = report["steps"][i];
    EXPECT_EQ(step["name"], names[i]);
    EXPECT_LT(step["seconds"].get<double>(), before) << "durations go monotone";
    before = step["seconds"].get<double>();
    EXPECT_GT(step["doubt_m"].get<double>(), 0);
    EXPECT_LT(step["source_foot_skate"].get<double>(), 0.25) << step.dump();
    skate[i] = step["foot_skate"];
    ASSERT_EQ(step["made_frames"].size(), 1u) << "all of them";
    EXPECT_EQ(step["made_frames"][0]["last"], step["frames"].get<int>() - 1);
  }
  EXPECT_LE(skate[1], std::max(skate[0], skate[2])) << "no more than where the captured ones are performed";
  const std::string bytes = read_bytes(out("blend.glb"));
  EXPECT_NE(bytes.find("made_frames"), std::string::npos) << "in the file's extras";
  ASSERT_EQ(blend({walk(), run()}, {"--steps", "3"}, "again.glb").code, 0);
  EXPECT_EQ(read_bytes(out("again.glb")), bytes) << "the same bytes";
}

TEST_F(Blending, OneBlendOfThreeIsWrittenToAnyFormatWithItsCycles) {
  const Finished done = blend({walk(), run(), walk() + "@20:60"},
                              {"--shares", "1,1,2", "--cycles", "3", "--fps", "60"}, "three.bvh");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("0.25 walk 1 0.25 run 0.50 walk@20:60"), std::string::npos) << done.out;
  EXPECT_NE(read_bytes(out("three.bvh")).find("Frame Time: 0.01666667"), std::string::npos);
}

TEST_F(Blending, WhatCannotBeBlendedIsToldInASentence) {
  WalkOptions still;
  still.motion = "still";
  write_walk(scratch.path("still.npz"), still);
  expect_clean_failure(blend({walk(), scratch.path("still.npz")}),
                       "nobody steps in it: tell the frames that are blended");
  expect_clean_failure(blend({walk()}), "2 to 4 movements");
  expect_clean_failure(blend({walk(), scratch.path("gone.npz")}), "there is no such file");
  expect_clean_failure(blend({walk(), run() + "@5"}), "is not FILE@FIRST:LAST");
  expect_clean_failure(blend({walk(), run() + "@5:9000"}), "has no frames 5 to 9000");
  expect_clean_failure(blend({walk(), target()}), "is no skeletal motion");
  expect_clean_failure(blend({walk(), run()}, {"--shares", "1,x"}), "is no list of weights");
  expect_clean_failure(blend({walk(), run()}, {"--shares", "1,1,1"}), "a blend of 2 movements");
  expect_clean_failure(blend({walk(), run()}, {"--shares", "1,1", "--steps", "3"}), "only one of both");
  expect_clean_failure(blend({walk(), run()}, {}, "five.bvh"), "holds one motion, not 5");
}

TEST_F(Blending, MotionsThatAreReadAreNotWrittenOver) {
  const Finished done =
      run_program({"blend", walk(), run(), "--target", target(), "--out", out("a.glb"), "--report", walk()});
  EXPECT_NE(done.code, 0);
  EXPECT_EQ(read_bytes(walk()).substr(0, 2), "PK");
}

}  // namespace
}  // namespace understudy::tests
