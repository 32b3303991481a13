// A motion on a character's own bones as BVH: what is read back plays as the character's GLB does.
#include "retarget/character/own_bones.hpp"

#include <gtest/gtest.h>

#include <map>

#include "retarget/character/character_export.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/motion/bvh.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::error_of;
using test::TempFolder;

constexpr int kFramesOfBones = 12;
constexpr double kBonesRate = 25;

std::map<std::string, Vec3> places_at(const Character& file, int frame, float scale) {
  std::map<std::string, Vec3> places;
  const PosedNodes posed = nodes_at(file, 0, static_cast<float>(frame / kBonesRate));
  for (size_t n = 0; n < file.nodes.size(); ++n)
    places[file.nodes[n].name] = scale * posed.world[n].topRightCorner<3, 1>();
  return places;
}

/// Millimetres between the bones of the BVH and those of the GLB of the same motion, at most over all frames.
float largest_bone_mm(const PreparedCharacter& character, const Joints& rest,
                      const std::vector<Pose>& poses) {
  const TempFolder folder;
  const RigDeformer screen(character, nullptr);
  CharacterExportOptions options;
  options.joints = rest;
  export_character(folder.path("a.glb"), {{character, screen, {{"walk", kBonesRate, poses}}, options}});
  OwnBonesBvh writer(folder.path("a.bvh"), std::make_shared<const PreparedCharacter>(character), rest,
                     kBonesRate);
  for (const Pose& pose : poses) writer.push(pose);
  writer.finish();
  const Character glb = parse_gltf_character(read_file(folder.path("a.glb")), "a.glb");
  const Character bvh = read_bvh(folder.path("a.bvh"));
  const auto bones = own_bones(character);
  float largest = 0;
  for (int f = 0; f < static_cast<int>(poses.size()); ++f) {
    const auto in_glb = places_at(glb, f, 1), in_bvh = places_at(bvh, f, 0.01f);
    for (const OwnBone& bone : bones) {
      const std::string& of_file = character.character.nodes[static_cast<size_t>(bone.node)].name;
      EXPECT_EQ(in_glb.count(of_file), 1u) << of_file;
      EXPECT_EQ(in_bvh.count(bone.name), 1u) << bone.name;
      largest = std::max(largest, 1000 * (in_glb.at(of_file) - in_bvh.at(bone.name)).norm());
    }
  }
  EXPECT_GE(bones.size(), 15u);
  return largest;
}

TEST(OwnBones, ABvhPlaysAsTheGlbOfTheSameMotion) {
  std::vector<MadeCharacter> all(6);
  all[1].arms_down_deg = 50, all[1].heading_deg = 90;
  all[2].unit = 0.01f, all[2].naming = Naming::Unreal;
  all[3].nested_scales = true, all[3].nodes_posed = true;
  all[4].naming = Naming::Rigify, all[4].legs_apart_deg = 15;
  all[5].naming = Naming::Smpl, all[5].separate_skins = true;
  for (const MadeCharacter& made : all) {
    const PreparedCharacter character = prepare_character(make_character(made), nullptr, nullptr);
    const Joints& rest = character.target.joints;
    EXPECT_LT(largest_bone_mm(character, rest, made_motion(kFramesOfBones, rest)), 1) << &made - all.data();
  }
}

TEST(OwnBones, PlatesThatHangOnNodesAreBonesToo) {
  const PreparedCharacter robot = prepare_character(make_robot(), nullptr, nullptr);
  ASSERT_TRUE(robot.rigged);
  const Joints& rest = robot.target.joints;
  EXPECT_LT(largest_bone_mm(robot, rest, made_motion(kFramesOfBones, rest)), 1);
}

TEST(OwnBones, JointsThatAUserMovedAreTurnedAbout) {
  const PreparedCharacter character = prepare_character(make_character(), nullptr, nullptr);
  Joints rest = character.target.joints;
  rest(LeftElbow, 0) -= 0.04f;
  rest(LeftElbow, 1) += 0.02f;
  EXPECT_LT(largest_bone_mm(character, rest, made_motion(kFramesOfBones, rest)), 1);
}

TEST(OwnBones, TheFileBeginsInTheCharactersOwnRestPose) {
  MadeCharacter made;
  made.arms_down_deg = 50;
  const PreparedCharacter character = prepare_character(make_character(made), nullptr, nullptr);
  const TempFolder folder;
  OwnBonesBvh writer(folder.path("a.bvh"), std::make_shared<const PreparedCharacter>(character),
                     character.target.joints, kBonesRate);
  Pose still = character.pose.back();
  still.root = character.target.joints.row(Pelvis).transpose();
  writer.push(still);
  writer.finish();
  const Character bvh = read_bvh(folder.path("a.bvh"));
  const PosedNodes zero = nodes_at(bvh, -1, 0), first = nodes_at(bvh, 0, 0);
  for (size_t n = 0; n < bvh.nodes.size(); ++n) {
    const Vec3 in_zero = (zero.world[n] * zero.world[0].inverse()).topRightCorner<3, 1>();
    const Vec3 in_first = (first.world[n] * first.world[0].inverse()).topRightCorner<3, 1>();
    EXPECT_LT((in_zero - in_first).norm(), 0.1f) << bvh.nodes[n].name;  // centimetres
  }
}

TEST(OwnBones, NamesAreWordsAndNoTwoAlike) {
  Character character = make_character();
  for (CharacterNode& node : character.nodes)
    if (node.name.find("Finger") != std::string::npos || node.name.find("Index") != std::string::npos)
      node.name = "a finger {1}";
  const auto bones = own_bones(prepare_character(std::move(character), nullptr, nullptr));
  std::map<std::string, int> count;
  for (const OwnBone& bone : bones) {
    EXPECT_EQ(bone.name.find_first_of(" {}"), std::string::npos) << bone.name;
    EXPECT_EQ(++count[bone.name], 1) << bone.name;
  }
}

TEST(OwnBones, AreAskedOfARigAlone) {
  MadeCharacter made;
  made.rigged = false;
  KnownExtractor known(made_joints(made));
  const PreparedCharacter character = prepare_character(make_character(made), &known, &known);
  EXPECT_TRUE(test::contains(error_of([&] { own_bones(character); }), "no bones of its own"));
}

}  // namespace
}  // namespace understudy::tests
