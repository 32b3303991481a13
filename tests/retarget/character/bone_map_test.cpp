#include "retarget/character/bone_map.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/character/bone_names.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::contains;
using test::error_of;

/// The joint whose bone make_character() put at each joint: bones come after the armature.
void expect_true_map(const BoneMap& map) {
  for (int j = 0; j < kJointCount; ++j) EXPECT_EQ(map.node[j], 1 + j) << kJointNames[j];
}

class EveryNaming : public testing::TestWithParam<Naming> {};

TEST_P(EveryNaming, MapsAllJoints) {
  MadeCharacter options;
  options.naming = GetParam();
  const Character character = make_character(options);
  const BoneMap map = map_bones(character, bind_pose(character).nodes);
  expect_true_map(map);
  EXPECT_TRUE(map.usable());
  for (const float sure : map.confidence) EXPECT_GT(sure, 0.9f);
}

INSTANTIATE_TEST_SUITE_P(BoneMap, EveryNaming,
                         testing::Values(Naming::Mixamo, Naming::Rigify, Naming::Vrm, Naming::Unreal,
                                         Naming::Biped, Naming::Smpl, Naming::Words, Naming::Cmu));

TEST(BoneMap, ReadsNamesOfManyKinds) {
  const auto read = [](const char* name) {
    const BoneName bone = parse_bone_name(name);
    return std::to_string(bone.side) + bone.what;
  };
  EXPECT_EQ(read("mixamorig:LeftUpLeg"), "-1thigh");
  EXPECT_EQ(read("J_Bip_R_LowerArm"), "1forearm");
  EXPECT_EQ(read("lShldr"), "-1shldr");
  EXPECT_EQ(read("Bip01 L UpperArm"), "-1upperarm");
  EXPECT_EQ(read("upperarm_twist_01_l"), "-1");
  EXPECT_EQ(read("RightHandIndex1"), "1");
  EXPECT_EQ(read("Lefthand"), "-1hand");
  EXPECT_EQ(read("hand.R"), "1hand");
  EXPECT_EQ(read("Leftover"), "0");  // a word that only begins so says nothing
}

TEST(BoneMap, FindsLimbsWithoutNames) {
  for (const float heading : {0.0f, 90.0f, 180.0f, 215.0f}) {
    MadeCharacter options;
    options.naming = Naming::None;
    options.heading_deg = heading;
    options.fingers = false;
    const Character character = make_character(options);
    const BoneMap map = map_bones(character, bind_pose(character).nodes);
    EXPECT_TRUE(map.usable()) << heading;
    for (const int j : {Pelvis, LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightAnkle, LeftShoulder,
                        RightShoulder, LeftElbow, RightElbow, LeftWrist, RightWrist, Spine3, Head})
      EXPECT_EQ(map.node[j], 1 + j) << kJointNames[j] << " " << heading;
    EXPECT_LT(map.confidence[LeftHip], 0.8f);
    EXPECT_TRUE(contains(map.how, "position"));
  }
}

TEST(BoneMap, TakesAChestThatIsCalledNeckForWhatItIs) {
  Character character = make_character();
  character.nodes[1 + Neck].name = "Throat";
  character.nodes[1 + Spine3].name = "Neck";
  const BoneMap map = map_bones(character, bind_pose(character).nodes);
  EXPECT_EQ(map.node[Spine3], 1 + Spine3);
}

TEST(BoneMap, TheUsersChoiceWinsAndTheLoserIsFree) {
  const Character character = make_character();
  const auto bind = bind_pose(character).nodes;
  const BoneMap map =
      map_bones(character, bind, {{"left_wrist", "mixamorig:LeftForeArm"}, {"left_foot", ""}});
  EXPECT_EQ(map.node[LeftWrist], 1 + LeftElbow);
  EXPECT_FALSE(map.has(LeftElbow));
  EXPECT_FALSE(map.has(LeftFoot));
  EXPECT_FALSE(map.usable());
}

TEST(BoneMap, RefusesChoicesThatCannotBe) {
  const Character character = make_character();
  const auto bind = bind_pose(character).nodes;
  const auto complaint = [&](const BoneChoices& choices) {
    return error_of([&] { map_bones(character, bind, choices); });
  };
  EXPECT_TRUE(contains(complaint({{"third_arm", "x"}}), "joint 'third_arm', which does not exist"));
  EXPECT_TRUE(contains(complaint({{"head", "Halo"}}), "bone 'Halo', which the character does not have"));
  EXPECT_TRUE(contains(complaint({{"head", "mixamorig:Neck"}, {"neck", "mixamorig:Neck"}}), "to both"));
}

TEST(BoneMap, TableNamesEveryJoint) {
  const Character character = make_character();
  const std::string table = to_table(map_bones(character, bind_pose(character).nodes), character);
  for (const char* joint : kJointNames) EXPECT_TRUE(contains(table, joint));
  EXPECT_TRUE(contains(table, "mixamorig:LeftUpLeg"));
  EXPECT_TRUE(contains(table, "Mixamo"));
}

}  // namespace
}  // namespace understudy::tests
