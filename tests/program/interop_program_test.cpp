// The shipped program from end to end: a character from another program's file performs scans; others read
// the result.
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"
#include "tests/interop/assimp_scene.hpp"
#include "tests/interop/exported.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

class ExportedByTheProgram : public testing::Test {
 protected:
  void SetUp() override {
    write_scans(folder.path("scans"), 5);
    MadeCharacter made;
    made.arms_down_deg = 40;
    write_gltf_character(folder.path("character.glb"), make_character(made));
  }
  /// The character as assimp writes it.
  std::string as(const char* format, const std::string& name) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(folder.path("character.glb"), 0);
    Assimp::Exporter exporter;
    US_CHECK(exporter.Export(scene, format, folder.path(name)) == AI_SUCCESS, exporter.GetErrorString());
    return folder.path(name);
  }
  std::string exported(const std::string& target, const std::string& name,
                       std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"export", "--source", folder.path("scans"), "--target",
                                          target,   "--out",    folder.path(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished done = run_program(arguments);
    US_CHECK(done.code == 0, target, ": ", done.err);
    return folder.path(name);
  }
  /// The validator has nothing to say, and three.js sees what we see.
  void expect_read_alike(const std::vector<std::string>& paths) {
    std::vector<PlayJob> jobs;
    for (const std::string& path : paths) jobs.push_back({path, path + ".three", 0, 30, {0, 0.05f, 0.1f}});
    for (const auto& report : validated(paths))
      EXPECT_TRUE(report["errors"] == 0 && report["warnings"] == 0) << report.dump().substr(0, 1000);
    const auto said = run_script("three_play.mjs", {"chromium", write_jobs(jobs)});
    for (size_t i = 0; i < jobs.size(); ++i) {
      ASSERT_FALSE(said[i].contains("failed")) << paths[i] << ": " << said[i]["failed"];
      const Character file = read_character(paths[i]);
      const auto theirs = read_positions(jobs[i], file.vertex_count());
      for (size_t t = 0; t < jobs[i].times.size(); ++t)
        EXPECT_LT(largest_mm(theirs[t], vertices_at(file, 0, jobs[i].times[t])), 0.1) << paths[i];
    }
  }
  ScratchFolder folder;
};

TEST_F(ExportedByTheProgram, IsReadAlikeWhereverTheCharacterCameFrom) {
  write_target(folder.path("bare.obj"));
  expect_read_alike({exported(folder.path("character.glb"), "glb.glb", {"--morphs", "3"}),
                     exported(as("collada", "from.dae"), "dae.gltf"),
                     exported(folder.path("bare.obj"), "obj.glb", {"--morphs", "3"})});
}

/// A rig as a file, and where its surface is in some of its frames.
struct MovingRig {
  std::string path;
  std::vector<int> frames;
  std::vector<Points> surfaces;
};

class FoundByTheProgram : public testing::Test {
 protected:
  static constexpr int kFrames = 8;
  static constexpr double kFps = 30;
  static const std::vector<int>& shown() {
    static const std::vector<int> frames = {0, 3, kFrames - 1};
    return frames;
  }
  /// Scans of the first creature of a kind.
  std::string scans_of(const std::string& kind) {
    if (!std::filesystem::exists(folder.path("cases")))
      EXPECT_EQ(run_program({"cases", "--suite", "creatures", "--out", folder.path("cases"), "--cases", "5",
                             "--frames", std::to_string(kFrames), "--points", "2000"})
                    .code,
                0);
    for (const auto& one : std::filesystem::directory_iterator(folder.path("cases")))
      if (one.path().filename().string().rfind(kind, 0) == 0) return (one.path() / "source").string();
    throw Error("no scans of " + kind);
  }
  /// As the program finds it in these scans, by its archive.
  MovingRig found(const std::string& kind) {
    const std::string path = folder.path(kind + ".glb"), archive = folder.path(kind + ".npz");
    ProgramOptions patient;
    patient.patience_s = 600;
    const Finished run =
        run_program({"discover", "--source", scans_of(kind), "--out", path, "--result", archive}, patient);
    US_CHECK(run.code == 0, kind, " ended with ", run.code, ": ", run.err);
    const NpyArray surfaces = read_npz(archive).at("vertices");
    MovingRig rig{path, shown(), {}};
    const auto vertices = static_cast<Eigen::Index>(surfaces.shape[1]);
    for (const int frame : shown())
      rig.surfaces.emplace_back(
          Eigen::Map<const Points>(surfaces.values.data() + 3 * vertices * frame, vertices, 3));
    return rig;
  }
  /// Hinges and a slider.
  MovingRig excavator() {
    RiggedMotion made{make_creature(CreatureKind::Excavator, 100), {}};
    made.motion = creature_motion(CreatureKind::Excavator, made.rig, 0, kFrames, kFps, 100);
    MovingRig rig{folder.path("true.glb"), shown(), {}};
    write_gltf_character(rig.path, to_character(made));
    for (const int frame : shown())
      rig.surfaces.push_back(skinned(made.rig.surface.vertices, made.rig.skin,
                                     bone_motions(made.rig, made.motion.poses[static_cast<size_t>(frame)])));
    return rig;
  }
  static void expect_same(const std::vector<Points>& theirs, const MovingRig& rig, const char* program) {
    for (size_t t = 0; t < rig.frames.size(); ++t)
      EXPECT_LT(largest_mm(theirs[t], rig.surfaces[t]), box_diagonal(rig.surfaces[t]))  // a thousandth of it
          << program << ", " << rig.path << ", frame " << rig.frames[t];
  }
  ScratchFolder folder;
};

TEST_F(FoundByTheProgram, RigsMoveElsewhereAsTheyDoHere) {
  const std::vector<MovingRig> rigs = {found("excavator"), found("quadruped"), excavator()};
  std::vector<std::string> paths;
  std::vector<PlayJob> jobs;
  for (const MovingRig& rig : rigs) {
    std::vector<float> times;
    for (const int frame : rig.frames) times.push_back(static_cast<float>(frame / kFps));
    paths.push_back(rig.path);
    jobs.push_back({rig.path, rig.path + ".three", 0, kFps, times});
  }
  for (const auto& report : validated(paths))
    EXPECT_EQ(report["messages"], nlohmann::json::array()) << report["file"];
  const auto said = run_script("three_play.mjs", {"chromium", write_jobs(jobs)});
  for (size_t i = 0; i < rigs.size(); ++i) {
    ASSERT_FALSE(said[i].contains("failed")) << paths[i] << ": " << said[i]["failed"];
    EXPECT_GT(said[i].value("covered", 0.0), 0.005) << paths[i] << " is hardly to be seen";
    expect_same(read_positions(jobs[i], rigs[i].surfaces[0].rows()), rigs[i], "three.js");
    AssimpScene scene(paths[i], read_character(paths[i]));
    std::vector<Points> read;
    for (const float seconds : jobs[i].times) read.push_back(scene.at(0, seconds));
    expect_same(read, rigs[i], "assimp");
  }
}

}  // namespace
}  // namespace understudy::tests
