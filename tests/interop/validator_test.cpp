// Khronos' glTF-Validator finds nothing to say against what we export.
#include <gtest/gtest.h>

#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "tests/app/program.hpp"
#include "tests/interop/exported.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

std::string first_messages(const nlohmann::json& report) {
  std::string out;
  for (const auto& message : report["messages"])
    if ((message["severity"] == "error" || message["severity"] == "warning") && out.size() < 1000)
      out += message.dump() + "\n";
  return out;
}

void expect_clean(const std::vector<std::string>& paths) {
  for (const auto& report : validated(paths)) {
    ASSERT_FALSE(report.contains("failed")) << report.dump();
    EXPECT_EQ(report["errors"], 0) << report["file"] << "\n" << first_messages(report);
    EXPECT_EQ(report["warnings"], 0) << report["file"] << "\n" << first_messages(report);
  }
}

TEST(Validator, FindsNoErrorAndNoWarningInAnyExport) {
  std::vector<std::string> paths;
  for (const Exported& exported : all_played()) paths.push_back(exported.path);
  expect_clean(paths);
}

/// What files of the world are like: a bone twice, directions of any length, faces without area, names twice.
Character careless() {
  Character out = make_character();
  for (CharacterPart& part : out.parts) {
    const Eigen::Index count = part.vertices.rows();
    part.joints.row(5).setConstant(7);
    part.weights.row(5).setConstant(0.25f);
    part.normals *= 3;
    part.normals.row(2).setZero();
    part.tangents = RowMatrix::Constant(count, 4, 0.2f);
    part.tangents.row(1).setZero();
    part.colors = RowMatrix::Constant(count, 4, 1.5f);
    part.faces.row(0).setConstant(4);  // no area
    part.uvs[0](0, 0) = 40;
  }
  out.nodes[3].name.clear();
  out.nodes[4].name = out.nodes[5].name;
  out.nodes[6].local.rotation.coeffs() *= 1.3f;
  return out;
}

TEST(Validator, FindsNothingInWhatACarelessFileBecomes) {
  const ScratchFolder folder;
  std::vector<std::string> paths;
  const PreparedCharacter character = prepare_character(careless(), nullptr, nullptr);
  const std::vector<Pose> poses = made_motion(9, character.target.joints);
  for (const bool their_rig : {true, false}) {
    BulgingDeformer ours(0.02f);
    ours.bind(character.target.mesh.vertices, character.target.joints);
    const RigDeformer rig(character, nullptr);
    CharacterExportOptions options;
    options.their_rig = their_rig;
    options.t_pose_clip = true;
    options.shapes = their_rig ? 0 : 3;
    paths.push_back(folder.path(their_rig ? "theirs.glb" : "ours.gltf"));
    const auto& screen = their_rig ? static_cast<const Deformer&>(rig) : ours;
    export_character(paths.back(),
                     {{character, screen, {{"", 30, poses}, {"still", 30, {poses[0]}}}, options}});
  }
  expect_clean(paths);
}

/// Pictures that only extensions know; KTX2's bytes are no more than its beginning.
Character with_extended_pictures() {
  Character out = make_character();
  const std::string webp = read_file(US_SOURCE_DIR "/tests/fuzz/corpus/picture/lossless.webp");
  out.images = {{"skin", "image/webp", webp}};
  out.textures = {R"({"extensions":{"EXT_texture_webp":{"source":0}}})"};
  out.extensions = out.required = {"EXT_texture_webp"};
  return out;
}

TEST(Validator, SaysNoMoreOfPicturesInExtensionsThanOfTheFileTheyCameIn) {
  const ScratchFolder folder;
  const std::string input = folder.path("input.glb");
  write_gltf_character(input, with_extended_pictures());
  const auto before = validated({input});
  std::vector<std::string> paths;
  const PreparedCharacter character = prepare_character(read_character(input), nullptr, nullptr);
  const RigDeformer rig(character, nullptr);
  for (const char* name : {"a.glb", "a.gltf"}) {
    paths.push_back(folder.path(name));
    export_character(paths.back(),
                     {{character, rig, {{"walk", 30, made_motion(5, character.target.joints)}}, {}}});
    EXPECT_EQ(read_character(paths.back()).images[0].bytes, character.character.images[0].bytes);
    EXPECT_EQ(read_character(paths.back()).required, character.character.required);
  }
  for (const auto& after : validated(paths)) {
    EXPECT_LE(after["errors"], before[0]["errors"]) << first_messages(after);
    EXPECT_LE(after["warnings"], before[0]["warnings"]) << first_messages(after);
  }
}

}  // namespace
}  // namespace understudy::tests
