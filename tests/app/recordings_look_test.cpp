// What a folder of recordings holds, as the dialog that teaches a style tells it.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/run/recordings_look.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::tests {
namespace {

app::RecordingsHeld held_in(app::RecordingsLook& look, const std::string& folder) {
  look.look(folder);
  app::RecordingsHeld held;
  for (int i = 0; i < 2000; ++i) {
    held = look.held();
    if (held.listed && held.timed == held.count) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return held;
}

TEST(RecordingsLook, TellsHowManyOfWhichKindsAndHowLong) {
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch.path("all/deeper"));
  WalkOptions part;
  part.last = 89;
  write_walk(scratch.path("all/walk.npz"), part);
  write_walk(scratch.path("all/deeper/walk.npz"), part);
  write_scans(scratch.path("all/scans"), 30);
  app::RecordingsLook look;
  EXPECT_EQ(look.held().sentence(), "");
  const app::RecordingsHeld held = held_in(look, scratch.path("all"));
  EXPECT_EQ(held.problem, "");
  EXPECT_EQ(held.count, 3u);
  EXPECT_EQ(held.sentence(), "3 recordings: 2 NPZ, 1 scans; 7.0 s");
  std::ofstream(scratch.path("all/broken.bvh")) << "HIERARCHY\nnothing";
  EXPECT_EQ(held_in(look, scratch.path("all")).sentence(),
            "4 recordings: 1 BVH, 2 NPZ, 1 scans; 7.0 s; 1 of them cannot be read");
  look.look("");
  EXPECT_FALSE(look.held().listed);
}

TEST(RecordingsLook, TellsWhyThereAreNone) {
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch.path("empty"));
  app::RecordingsLook look;
  EXPECT_NE(held_in(look, scratch.path("empty")).problem.find("holds no skeletal motion"), std::string::npos);
  EXPECT_NE(held_in(look, scratch.path("absent")).problem.find("no such folder"), std::string::npos);
  EXPECT_EQ(look.held().sentence(), "");
}

}  // namespace
}  // namespace understudy::tests
