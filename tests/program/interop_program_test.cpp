// The shipped program from end to end: a character from another program's file performs scans; others read
// the result.
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"
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

}  // namespace
}  // namespace understudy::tests
