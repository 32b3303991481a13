// `understudy map`: a picture, a table and a report of the steps of many motions, and what is alike.
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "render/image.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Mapping : public ShippedProgram {
 protected:
  Mapping() {
    fs::create_directories(scratch.path("motions/fast"));
    write_walk(scratch.path("motions/walk.npz"));
    WalkOptions fast, still;
    fast.fps = 48, still.motion = "still";
    write_walk(scratch.path("motions/fast/run_1.npz"), fast);
    write_walk(scratch.path("motions/still.npz"), still);
  }
  std::string motions() const { return scratch.path("motions"); }
  Finished map(std::vector<std::string> paths, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"map", "--index", scratch.path("index")};
    arguments.insert(arguments.end(), paths.begin(), paths.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(Mapping, WritesPictureTableAndReportAndNamesWhatIsLeftOut) {
  write_text(scratch.path("motions/broken.bvh"), "HIERARCHY\nROOT hips\n{\n");
  const Finished run = map({motions()}, {"--out", out("map.png"), "--csv", out("map.csv"), "--report",
                                         out("report.json"), "--color", "speed"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("4 files, 4 read anew, "), std::string::npos) << run.out;
  EXPECT_NE(run.err.find("still.npz: nobody steps in it"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("broken.bvh"), std::string::npos) << run.err;
  EXPECT_EQ(render::read_png(out("map.png")).width, 1600);
  const Json report = Json::parse(read_bytes(out("report.json")));
  EXPECT_EQ(report["motions"], 2);
  EXPECT_EQ(report["problems"].size(), 1u);
  EXPECT_EQ(report["without_steps"].size(), 1u);
  const std::string table = read_bytes(out("map.csv"));
  EXPECT_EQ(line_count(table), report["steps"].get<int>() + 1);
  EXPECT_EQ(table.find("step,file,animation,first,last,action,"), 0u);
  EXPECT_NE(table.find(",run,"), std::string::npos) << "the action, of the file's name";
}

TEST_F(Mapping, WhatIsUnchangedIsNotReadAgainAndDamageIsMended) {
  ASSERT_EQ(map({motions()}, {"--csv", out("a.csv")}).code, 0);
  const Finished again = map({motions()}, {"--csv", out("b.csv")});
  EXPECT_NE(again.out.find("3 files, 0 read anew, "), std::string::npos) << again.out;
  EXPECT_EQ(read_bytes(out("a.csv")), read_bytes(out("b.csv")));
  for (const auto& entry : fs::directory_iterator(scratch.path("index")))
    write_text(entry.path().string(), "{\"format\"");
  const Finished mended = map({motions()}, {"--csv", out("c.csv")});
  ASSERT_EQ(mended.code, 0) << mended.err;
  EXPECT_NE(mended.out.find("3 entries of the index were damaged and are made again"), std::string::npos)
      << mended.out;
  EXPECT_EQ(read_bytes(out("a.csv")), read_bytes(out("c.csv")));
}

TEST_F(Mapping, TellsWhatIsAlike) {
  const std::string walk = scratch.path("motions/walk.npz");
  const Finished run =
      map({motions()}, {"--like", walk + "@20:80", "--count", "3", "--report", out("r.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json like = Json::parse(read_bytes(out("r.json")))["like"];
  ASSERT_EQ(like.size(), 3u);
  EXPECT_EQ(like[0]["file"], walk) << "another cycle";
  EXPECT_TRUE(like[0]["last"].get<int>() < 20 || like[0]["first"].get<int>() > 80);
  EXPECT_NE(run.out.find("times as far from the nearest step as neighbours are"), std::string::npos);
}

TEST_F(Mapping, RefusesWhatCannotBeDone) {
  const std::string walk = scratch.path("motions/walk.npz");
  expect_clean_failure(map({motions()}, {}), "nothing is to be written");
  expect_clean_failure(map({scratch.path("nowhere")}, {"--out", out("m.png")}), "there is no such file");
  expect_clean_failure(map({motions()}, {"--out", out("m.jpg")}), "only .png");
  expect_clean_failure(map({motions()}, {"--like", walk + "@3:9"}), "nobody makes a whole step (0.3 to 3 s)");
  expect_clean_failure(map({motions()}, {"--like", walk + "@3"}), "is not FILE@FIRST:LAST");
  expect_clean_failure(map({motions()}, {"--like", walk + "@3:9000"}), "has no frames 3 to 9000");
  expect_clean_failure(map({scratch.path("motions/still.npz")}, {"--out", out("m.png")}), "nobody steps");
  fs::create_directories(scratch.path("empty"));
  expect_clean_failure(map({scratch.path("empty")}, {"--out", out("m.png")}), "holds no skeletal motion");
  expect_clean_failure(map({walk}, {"--csv", walk}), walk);
}

TEST_F(Mapping, KilledWhileItReadsLosesNothing) {
  for (int i = 0; i < 60; ++i) write_walk(scratch.path("motions/more_" + std::to_string(i) + ".npz"));
  const std::vector<std::string> words = {"map",   motions(),   "--index", scratch.path("index"),
                                          "--csv", out("a.csv")};
  const auto entries = [&] {
    std::error_code none;
    int count = 0;
    for (const auto& entry : fs::directory_iterator(scratch.path("index"), none))
      count += entry.path().extension() == ".json" ? 1 : 0;
    return count;
  };
  int kept = 0;
  {
    Program killed(words);
    for (int wait = 0; wait < 6000 && entries() < 5; ++wait) ::usleep(5000);
    killed.send(SIGKILL);
    killed.finish();
    kept = entries();
  }
  ASSERT_GE(kept, 5);
  EXPECT_FALSE(fs::exists(out("a.csv")));
  const Finished run = run_program(words);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("63 files, " + std::to_string(63 - kept) + " read anew, "), std::string::npos)
      << run.out << kept;
  EXPECT_EQ(run.out.find("damaged"), std::string::npos) << run.out;
}

TEST_F(Mapping, ControlCLeavesNoOutputAndSaysWhatIsKept) {
  for (int i = 0; i < 200; ++i) write_walk(scratch.path("motions/more_" + std::to_string(i) + ".npz"));
  Program stopped({"map", motions(), "--index", scratch.path("index"), "--csv", out("a.csv")});
  std::error_code none;
  for (int wait = 0; wait < 6000 && !fs::exists(scratch.path("index"), none); ++wait) ::usleep(5000);
  stopped.send(SIGINT);
  expect_clean_failure(stopped.finish(), "what was read is kept for the next time");
}

}  // namespace
}  // namespace understudy::tests
