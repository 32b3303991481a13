// One motion in every format, what an export leaves behind when it ends badly, and what it says it costs.
#include "app/run/exports.hpp"
#include "app/run/export_presets.hpp"
#include "app/run/file_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::FullDisk;
using test::TempFolder;

constexpr int kFrames = 12;

ExportInput input_of(std::shared_ptr<const PreparedCharacter> character) {
  ExportInput input;
  input.body.character = character;
  input.body.screen = std::make_shared<RigDeformer>(*character, nullptr);
  input.clips = {{"walk", 25, tests::made_motion(kFrames, character->target.joints)}};
  return input;
}

ExportInput made_input() {
  return input_of(
      std::make_shared<PreparedCharacter>(prepare_character(tests::make_character(), nullptr, nullptr)));
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(FileFigures, AreThoseOfTheWrittenSurface) {
  const ExportInput input = made_input();
  const PreparedCharacter& character = *input.body.character;
  Truth truth;
  truth.frames = kFrames;
  truth.vertex_count = static_cast<int64_t>(character.surface.in_file.size());
  const auto frame = [&](int t) {
    return character.surface.in_file_order(
        input.body.screen->deform(input.clips[0].poses[static_cast<size_t>(t)]));
  };
  const auto add = [&](float scale) {
    truth.vertices.clear();
    for (int t = 0; t < kFrames; ++t) {
      const Points points = scale * frame(t);
      truth.vertices.insert(truth.vertices.end(), points.data(), points.data() + points.size());
    }
  };
  const auto figure = [](const Metrics& metrics, const std::string& key) {
    for (const auto& [name, value] : metrics)
      if (name == key) return value;
    return std::nan("");
  };
  add(1);
  const Metrics same = file_figures(input.body, input.clips[0], truth);
  EXPECT_LT(figure(same, "file_mpvd_m"), 1e-4);
  EXPECT_LT(figure(same, "file_medl_mm"), 0.01);
  EXPECT_LT(figure(same, "file_screen_mm"), 0.1);
  EXPECT_GT(figure(same, "file_mb"), 0.001);
  add(1.1f);
  const Metrics larger = file_figures(input.body, input.clips[0], truth);
  EXPECT_GT(figure(larger, "file_medl_mm"), 1);
  EXPECT_GT(figure(larger, "file_mpvd_m"), 0.02);
  truth.frames = kFrames - 1;
  EXPECT_TRUE(
      contains(error_of([&] { file_figures(input.body, input.clips[0], truth); }), "number of frames"));
}

TEST(CheckExportOptions, WhatAFileCannotHoldIsRefusedAndNotLeftOut) {
  const auto refused = [](const ExportFormat& format, auto change) {
    CharacterExportOptions file;
    change(file);
    return error_of([&] { check_export_options("a", format, file); });
  };
  EXPECT_TRUE(
      contains(refused(export_format("bvh", ""), [](auto& file) { file.shapes = 3; }), "no morph targets"));
  EXPECT_TRUE(contains(refused(export_format("npz", ""), [](auto& file) { file.influences = 8; }),
                       "no skin weights"));
  EXPECT_TRUE(
      contains(refused(export_format("obj", ""), [](auto& file) { file.reduce_mm = 1; }), "every frame"));
  EXPECT_TRUE(
      contains(refused(export_format("amass", ""), [](auto& file) { file.keep_clips = true; }), "own clips"));
  EXPECT_TRUE(contains(refused(export_format("glb", ""),
                               [](auto& file) {
                                 file.their_rig = false;
                                 file.keep_clips = true;
                               }),
                       "own clips"));
  EXPECT_TRUE(
      contains(refused(export_format("glb", ""), [](auto& file) { file.in_place = file.root_motion = true; }),
               "either left out"));
  for (const ExportFormat& info : export_formats()) {
    EXPECT_NO_THROW(check_export_options("a", info, {})) << info.name;
    EXPECT_EQ(error_of([&] { check_own_bones("a", info); }).empty(), info.own_bones) << info.name;
  }
}

class EveryFormat : public testing::TestWithParam<ExportFormat> {
 protected:
  TempFolder folder_;
  std::string path_ = folder_.path(std::string("dance") + GetParam().suffix);
  ExportInput input_ = made_input();

  void export_it() { export_motion(path_, GetParam(), {input_}); }
  /// Of what is at the path: of a folder's first frame.
  std::string content() const {
    if (!fs::is_directory(path_)) return read_file(path_);
    return read_file(path_ + "/" + names_in(path_)[0]);
  }
};

TEST_P(EveryFormat, IsWrittenWholeAndTheSameTwice) {
  const ExportCost cost = export_motion(path_, GetParam(), {input_});
  EXPECT_EQ(cost.frames, kFrames);
  EXPECT_GT(cost.bytes, 1000);
  EXPECT_LT(cost.largest_mm, 0.1);
  const std::string first = content();
  const auto files = names_in(folder_.path());
  export_it();
  EXPECT_EQ(content(), first);
  EXPECT_EQ(names_in(folder_.path()), files);
}

TEST_P(EveryFormat, AFullDiskLeavesTheOldFile) {
  export_it();
  const std::string before = content();
  const auto files = names_in(folder_.path());
  input_.clips[0].poses.resize(kFrames - 1);
  std::string complaint;
  {
    const FullDisk full(700);
    complaint = error_of([&] { export_it(); });
  }
  EXPECT_TRUE(contains(complaint, "dance")) << complaint;
  EXPECT_TRUE(contains(complaint, "cannot be written")) << complaint;
  EXPECT_EQ(content(), before);
  EXPECT_EQ(names_in(folder_.path()), files);
}

TEST_P(EveryFormat, WhoStopsItKeepsTheOldFile) {
  export_it();
  const std::string before = content();
  const auto files = names_in(folder_.path());
  input_.clips[0].poses.resize(kFrames - 1);
  int asked = 0;
  input_.body.file.progress = [&](float done) {
    EXPECT_GE(done, 0);
    EXPECT_LE(done, 1);
    if (++asked == 4) throw Error("stopped");
  };
  EXPECT_EQ(error_of([&] { export_it(); }), "stopped");
  EXPECT_EQ(content(), before);
  EXPECT_EQ(names_in(folder_.path()), files);
}

TEST_P(EveryFormat, NamesAPathThatCannotBe) {
  path_ = folder_.path(std::string("no/such/place") + GetParam().suffix);
  if (*GetParam().suffix) EXPECT_TRUE(contains(error_of([&] { export_it(); }), "no/such/place"));
  input_.clips.clear();
  EXPECT_TRUE(contains(error_of([&] { export_it(); }), "no motion"));
}

TEST_P(EveryFormat, IsFoundByItsName) {
  EXPECT_STREQ(export_format(GetParam().name, "whatever").name, GetParam().name);
  if (GetParam().by_suffix) EXPECT_STREQ(export_format("", path_).name, GetParam().name);
}

TEST_P(EveryFormat, InPlaceStaysWhereTheTargetStands) {
  if (std::string(GetParam().name) != "npz") return;  // the others take the same poses
  for (Pose& pose : input_.clips[0].poses) pose.root.x() += 5;
  input_.body.file.in_place = true;
  input_.source_to_scan(2, 3) = 0.5;
  export_it();
  EXPECT_EQ(read_npz(path_).at("source_to_scan").values[11], 0.5f);
  const NpyArray joints = read_npz(path_).at("joints");
  for (int t = 0; t < kFrames; ++t)
    EXPECT_NEAR(joints.values[static_cast<size_t>(t) * 66], input_.body.character->target.joints(0, 0),
                1e-5f);
}

INSTANTIATE_TEST_SUITE_P(Exports, EveryFormat, testing::ValuesIn(export_formats()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Exports, FormatsThatHoldOneMotionSaySo) {
  const TempFolder folder;
  ExportInput input = made_input();
  input.clips.push_back(input.clips[0]);
  EXPECT_TRUE(
      contains(error_of([&] { export_motion(folder.path("a.bvh"), export_format("bvh", ""), {input}); }),
               "one motion"));
  export_motion(folder.path("a.glb"), export_format("glb", ""), {input});
  EXPECT_EQ(read_character(folder.path("a.glb")).animations.size(), 2u);
}

TEST(Exports, SeveralPerformersShareAGlbAndNothingElse) {
  const TempFolder folder;
  std::vector<ExportInput> performers = {made_input(), made_input()};
  performers[0].name = "Ann", performers[1].name = "Bob";
  EXPECT_EQ(error_of([&] { export_motion(folder.path("a.bvh"), export_format("bvh", ""), performers); }),
            folder.path("a.bvh") + ": BVH holds one motion, not 2 performers");
  const ExportCost cost = export_motion(folder.path("a.glb"), export_format("glb", ""), performers);
  EXPECT_LT(cost.largest_mm, 0.1);
  const Character file = read_character(folder.path("a.glb"));
  EXPECT_EQ(file.animations.size(), 1u);
  for (const char* name : {"Ann", "Bob"})
    EXPECT_TRUE(std::any_of(file.nodes.begin(), file.nodes.end(), [&](const CharacterNode& node) {
      return node.name == name;
    })) << name;
  performers[1].clips.clear();
  EXPECT_TRUE(
      contains(error_of([&] { export_motion(folder.path("a.glb"), export_format("glb", ""), performers); }),
               "no motion"));
}

TEST(ExportPresets, EachIsKnownByItsOptionsAndCanBeWritten) {
  CharacterExportOptions own;
  EXPECT_EQ(preset_of(export_format("glb", ""), own), nullptr);
  for (const ExportPreset& preset : export_presets()) {
    CharacterExportOptions file;
    file.in_place = true;
    apply(preset, file);
    EXPECT_EQ(file.in_place, !preset.root_motion) << "a root bone has a path to carry";
    const ExportFormat& format = export_format(preset.format, "");
    EXPECT_NO_THROW(check_export_options("a", format, file)) << preset.name;
    EXPECT_EQ(preset_of(format, file), &export_preset(preset.name));
    EXPECT_EQ(preset_of(export_format("bvh", ""), file), nullptr);
  }
  EXPECT_TRUE(contains(error_of([] { export_preset("maya"); }), "three|unity|unreal|blender"));
}

TEST(Exports, UnknownFormatsAreNamed) {
  EXPECT_TRUE(contains(error_of([] { export_format("", "a.fbx"); }), "a.fbx"));
  EXPECT_TRUE(contains(error_of([] { export_format("fbx", "a"); }), "glb, gltf, bvh"));
}

TEST(Exports, SurfacesAreThoseOfTheScreenInTheFilesOrder) {
  const TempFolder folder;
  const ExportInput input = made_input();
  const PreparedCharacter& character = *input.body.character;
  export_motion(folder.path("ply"), export_format("ply", ""), {input});
  export_motion(folder.path("obj"), export_format("obj", ""), {input});
  const Points want = character.surface.in_file_order(input.body.screen->deform(input.clips[0].poses[6]));
  for (const char* name : {"ply/frame_00007.ply", "obj/frame_00007.obj"}) {
    const Mesh mesh = read_mesh(folder.path(name));
    EXPECT_EQ(mesh.vertices, want) << name;
    EXPECT_EQ(mesh.faces.rows(), character.target.mesh.faces.rows());
  }
}

TEST(Exports, ABarePointCloudIsPointsInEveryFormat) {
  const TempFolder folder;
  tests::MadeCharacter made;
  made.rigged = false;
  const Character body = tests::make_character(made);
  Mesh cloud;
  cloud.vertices = posed_vertices(body, body.world());
  tests::KnownExtractor known(tests::made_joints(made));
  auto character = std::make_shared<PreparedCharacter>(
      prepare_character(character_of_mesh(cloud, "cloud"), &known, &known));
  auto screen = std::make_shared<tests::BulgingDeformer>();
  screen->bind(character->target.mesh.vertices, character->target.joints);
  ExportInput input;
  input.body = {character, screen, {}};
  input.body.file.their_rig = false;
  input.clips = {{"walk", 25, tests::made_motion(3, character->target.joints)}};
  for (const ExportFormat& info : export_formats())
    export_motion(folder.path(std::string("cloud_") + info.name + info.suffix), info, {input});
  const Character glb = read_character(folder.path("cloud_glb.glb"));
  EXPECT_EQ(glb.parts[0].faces.rows(), 0);
  EXPECT_EQ(glb.parts[0].skin, 0);
  EXPECT_TRUE(read_mesh(folder.path("cloud_ply/frame_00001.ply")).is_cloud());
}

TEST(Exports, SayWhatTheyCost) {
  ExportCost cost;
  cost.frames = 12345;
  cost.bytes = 1240000;
  EXPECT_EQ(sentence(cost), "12,345 frames, 1.2 MB");
  cost.measured = true;
  cost.mean_mm = 0.412;
  cost.largest_mm = 2.1;
  EXPECT_EQ(sentence(cost), "differs from the viewport by 0.412 mm on average, 2.10 mm at most; 1.2 MB");
}

}  // namespace
}  // namespace understudy::app
