#include "app/session/studio.hpp"

#include <algorithm>
#include <mutex>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

TEST_F(StudioTest, ANewTargetLeavesTheFrameAndItsJointsAreSeenWhole) {
  Studio studio(services());
  open_both(studio);
  studio.run("playback.frame", {"12"});
  studio.run("open", {path("target.obj")});
  studio.tick(0.01);
  studio.wait_idle();
  studio.tick(0.01);
  EXPECT_EQ(shown_frame(studio.session()), 12);
  studio.run("edit.crop", {"-9", "-9", "-9", "9", "9", "9"});
  studio.wait_idle();
  EXPECT_EQ(shown_frame(studio.session()), 12);
  studio.run("view.fit");
  studio.run("view.zoom", {"0.3"});
  const float near = studio.session().view.cameras[0].distance;
  studio.run("tool", {"target-joints"});
  EXPECT_GT(studio.session().view.cameras[0].distance, 2 * near);
}

TEST_F(StudioTest, ExportsTheFramesThatTrimAndSkipLeave) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.trim", {"0", "4", "13"});
  studio.run("edit.skip", {"0", "7", "on"});
  studio.run("export.run", {"0", path("out.npz")});
  studio.run("export.run", {"0", path("out.glb"), "morphs=2", "t_pose=on"});
  studio.run("export.csv", {"0", path("out.csv")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  EXPECT_EQ(read_npz(path("out.npz")).at("joints").shape[0], 9);
  EXPECT_GT(fs::file_size(path("out.glb")), 1000u);
  EXPECT_GT(fs::file_size(path("out.csv")), 100u);
}

TEST_F(StudioTest, AnExportSaysWhatItCostsAndWhatItCannotDo) {
  std::mutex guard;
  std::vector<std::string> logged;
  const log::Sink before = log::set_sink([&](log::Level, const std::string& line) {
    const std::lock_guard<std::mutex> lock(guard);
    logged.push_back(line);
  });
  Studio studio(services());
  open_both(studio);
  studio.run("export.run", {"0", path("out.bvh"), "in_place=on"});
  studio.run("export.run", {"0", path("frames"), "format=obj"});
  studio.wait_idle();
  log::set_sink(before);
  EXPECT_EQ(std::count(logged.begin(), logged.end(), path("out.bvh") + ": is written"), 1);
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  EXPECT_TRUE(fs::exists(path("frames/frame_00024.obj")));
  std::string told;
  for (const Notice& notice : studio.session().notices) told += notice.text + "; ";
  EXPECT_NE(told.find("Exported out.bvh: 24 frames"), std::string::npos) << told;
  const Offer& offer = studio.session().notices.back().offer;
  EXPECT_EQ(offer.label, "Show in folder");
  EXPECT_EQ(split_line(offer.command).at(0), "file.show");
  EXPECT_NE(told.find("by 0 mm on average"), std::string::npos) << told;
  const auto refused = [&](const Arguments& arguments) {
    try {
      studio.run("export.run", arguments);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({"0", path("out.fbx")}).find("out.fbx"), std::string::npos);
  EXPECT_NE(refused({"0", path("out.glb"), "bones=9"}).find("bones"), std::string::npos);
  EXPECT_NE(refused({"0", path("out.glb"), "influences=5"}).find("4, 8"), std::string::npos);
  EXPECT_NE(refused({"7", path("out.glb")}).find("no take 7"), std::string::npos);
}

TEST_F(StudioTest, GettingStartedComesAtTheFirstStartAloneAndStaysAway) {
  const auto card_at_start = [&](bool greets, bool skip) {
    StudioServices with_settings = services();
    with_settings.settings_file = path("config/settings.json");
    with_settings.greets_newcomers = greets;
    Studio studio(std::move(with_settings));
    const int card = studio.session().settings.getting_started;
    if (skip) studio.run("help.getting_started", {"off"});
    return card;
  };
  EXPECT_EQ(Studio(services()).session().settings.getting_started, 0) << "as scripts do";
  EXPECT_EQ(card_at_start(false, false), 0);
  fs::remove_all(path("config"));
  EXPECT_EQ(card_at_start(true, false), 1);
  EXPECT_EQ(card_at_start(true, true), 1) << "it was not ended";
  EXPECT_EQ(card_at_start(true, false), 0) << "skipped for good";
  std::ofstream(path("config/settings.json")) << "{}";  // of a version before
  EXPECT_EQ(card_at_start(true, false), 0) << "somebody who was here before";
}

TEST_F(StudioTest, AFailureIsSaidUntilTheCommandSucceedsOrTheDocumentIsNew) {
  Studio studio(services());
  const auto said = [&] {
    studio.tick(20);
    const auto line = status_line(studio.session());
    return line ? line->text : std::string();
  };
  studio.try_run("source.open", {path("nowhere")});
  EXPECT_NE(said().find("nowhere"), std::string::npos);
  studio.run("tool", {"look"});
  EXPECT_NE(said().find("nowhere"), std::string::npos) << "that mends nothing";
  studio.run("open", {path("scan.npz")});
  EXPECT_EQ(said(), "");
  studio.try_run("target.add", {path("nobody.obj")});
  EXPECT_NE(said().find("nobody"), std::string::npos);
  studio.run("document.new");
  EXPECT_NE(said().find("nobody"), std::string::npos) << "it asks about the changes first";
  studio.run("question.answer", {"discard"});
  EXPECT_EQ(said(), "");
}

TEST_F(StudioTest, ACancelledExportLeavesTheOldFile) {
  std::ofstream(path("out.glb")) << "old";
  Studio studio(services());
  open_both(studio);
  studio.run("export.run", {"0", path("out.glb"), "morphs=4"});
  studio.jobs().cancel(studio.jobs().views().back().id);
  studio.wait_idle();
  std::ifstream file(path("out.glb"));
  std::string text;
  file >> text;
  if (text != "old") EXPECT_EQ(text.substr(0, 4), "glTF");  // it was quicker
  for (const auto& entry : fs::directory_iterator(fs::path(path("out.glb")).parent_path()))
    EXPECT_NE(entry.path().extension(), ".part");
  EXPECT_TRUE(studio.session().errors.empty());
}

TEST_F(StudioTest, OfSeveralThingsOpenedOneThatFailsKeepsNoOtherOut) {
  Studio studio(services());
  studio.run("open", {path("not_there.ply"), path("scan.npz"), path("target.obj")});
  studio.wait_idle();
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_NE(studio.session().errors.front().text.find("not_there.ply"), std::string::npos);
  EXPECT_EQ(frame_count(studio.session()), kFrames);
}

TEST_F(StudioTest, NoCommandCrashesOnNonsense) {
  Studio studio(services());
  open_both(studio);
  const std::vector<Arguments> nonsense = {
      {}, {"x"}, {"-1"}, {"99"}, {"0", "1e99", "nan"}, {"0", "-5", "7", "x", "y", "z"}};
  std::vector<std::string> names;
  for (const Command& command : studio.commands().all()) names.push_back(command.name);
  for (const std::string& name : names)
    for (const Arguments& arguments : nonsense) {
      try {
        studio.run(name, arguments);
      } catch (const Error& error) {
        EXPECT_GT(std::string(error.what()).size(), 8u) << name;
      }
      studio.session().question.reset();
      studio.tick(0.01);
    }
  studio.wait_idle();
}

TEST_F(StudioTest, PlaysRoundAndStopsAtTheEndWithoutALoop) {
  Studio studio(services());
  open_both(studio);
  studio.run("playback.frame", {"0"});
  studio.run("playback.play");
  studio.tick(kFrames / 30.0 + 0.1);
  EXPECT_EQ(shown_frame(studio.session()), 3);
  studio.run("playback.loop", {"off"});
  studio.tick(10);
  EXPECT_EQ(shown_frame(studio.session()), kFrames - 1);
  EXPECT_FALSE(studio.session().playback.playing);
}

TEST_F(StudioTest, ASuffixInCapitalsOpensAsTheSameInSmallLetters) {
  fs::copy_file(US_SOURCE_DIR "/tests/fuzz/corpus/bvh/walk.bvh", path("WALK.BVH"));
  fs::copy_file(path("scan.npz"), path("SCAN.NPZ"));
  fs::copy_file(path("target.obj"), path("TARGET.OBJ"));
  std::ofstream(path("ALL.LST")) << "target.obj\n";
  Studio studio(services());
  for (const char* source : {"WALK.BVH", "SCAN.NPZ", "ALL.LST"}) {
    studio.run("open", {path(source)});
    EXPECT_EQ(studio.session().document.source.path, path(source));
  }
  EXPECT_TRUE(studio.session().document.takes.empty());
  studio.run("open", {path("TARGET.OBJ")});
  ASSERT_EQ(studio.session().document.takes.size(), 1u);
  studio.run("document.save_as", {path("WORK.UNDERSTUDY")});
  EXPECT_TRUE(fs::exists(path("WORK.UNDERSTUDY")));
  studio.run("document.new");
  studio.run("open", {path("WORK.UNDERSTUDY")});
  EXPECT_EQ(studio.session().document.takes.size(), 1u);
}

TEST_F(StudioTest, OfALargeGltfOnlyWhatTellsItsKindIsReadAtOnce) {
  const std::string animations = R"("animations":[{"channels":[{"sampler":0,"target":{}}]}])";
  std::ofstream(path("first.gltf")) << "{" << animations << R"(,"buffers":[{"uri":")";
  fs::resize_file(path("first.gltf"), uint64_t{5} << 30);  // sparse, more than would ever be read
  std::ofstream(path("last.gltf")) << "{" << std::string(3 << 20, ' ') << animations << "}";
  for (const char* name : {"first.gltf", "last.gltf"}) {
    Studio studio(services());
    studio.run("open", {path("target.obj")});
    studio.run("open", {path(name)});
    const std::string& source = studio.session().document.source.path;
    EXPECT_EQ(source, name == std::string("first.gltf") ? path(name) : "");
    studio.wait_idle();
    ASSERT_EQ(studio.session().errors.size(), 1u) << "opened as a source, and damaged";
    EXPECT_EQ(studio.session().errors.front().details, "source.open");
    EXPECT_EQ(source, "");
    EXPECT_EQ(studio.session().document.takes.size(), 1u);
  }
}

TEST_F(StudioTest, WhateverCanBeATargetOpensAsOne) {
  Studio studio(services());
  studio.run("open", {path("scan.npz")});  // without a source what moves would become it
  size_t takes = 0;
  for (const char* name : {"a.xyz", "b.PCD", "e.ply", "f.GLB"}) {
    std::ofstream(path(name)) << "x";
    studio.run("open", {path(name)});
    ASSERT_EQ(studio.session().document.takes.size(), ++takes) << name;
  }
  // These are read by a worker, which is the program itself: this one has none.
  for (const char* name : {"c.FBX", "d.dae"}) EXPECT_TRUE(can_be(name, kTarget)) << name;
}

}  // namespace
}  // namespace understudy::app
