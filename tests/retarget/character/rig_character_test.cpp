#include "retarget/character/rig_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/support/moving_arm.hpp"

namespace understudy {
namespace {

constexpr float kTenthMillimetre = 1e-4f;

Character through_bytes(const Character& character) {
  return parse_gltf_character(gltf_bytes(character, "rig.glb"), "rig.glb");
}

Points posed(const RiggedMotion& performed, size_t t) {
  return skinned(performed.rig.surface.vertices, performed.rig.skin,
                 bone_motions(performed.rig, performed.motion.poses[t]));
}

/// The bending arm, its weights blended about the joints, coloured; its wrist slides out.
RiggedMotion telescope() {
  RiggedMotion arm = test::bending_arm(9);
  RowMatrix weights = RowMatrix::Zero(arm.rig.skin.size(), 3);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float x = arm.rig.surface.vertices(v, 0);
    const float second = std::clamp(2 * (x - 0.75f), 0.0f, 1.0f),
                third = std::clamp(2 * (x - 1.75f), 0.0f, 1.0f);
    weights.row(v) << 1 - second, second - third, third;
  }
  arm.rig.skin = SkinWeights::from(weights);
  arm.rig.surface.colors = Points::Constant(weights.rows(), 3, 0.25f);
  arm.rig.joints[2].kind = JointKind::Slider;
  arm.rig.joints[2].axis = Vec3::UnitX();
  for (size_t t = 0; t < arm.motion.poses.size(); ++t) {
    arm.motion.poses[t].turns[2].setIdentity();
    arm.motion.poses[t].slides[2] = 0.05f * static_cast<float>(t);
  }
  return arm;
}

void expect_same(const RiggedMotion& is, const RiggedMotion& should) {
  ASSERT_EQ(is.motion.poses.size(), should.motion.poses.size());
  for (size_t t = 0; t < should.motion.poses.size(); ++t)
    EXPECT_LT((posed(is, t) - posed(should, t)).rowwise().norm().maxCoeff(), kTenthMillimetre) << t;
}

TEST(RigCharacter, IsThereAgainAfterAFile) {
  for (const RiggedMotion& arm : {telescope(), test::bending_arm(9)}) {
    const Character file = through_bytes(to_character(arm));
    for (size_t t = 0; t < arm.motion.poses.size(); ++t)
      EXPECT_LT(
          (vertices_at(file, 0, static_cast<float>(t) / 30) - posed(arm, t)).rowwise().norm().maxCoeff(),
          kTenthMillimetre);
    const RiggedMotion again = from_character(file, 0, 30);
    expect_same(again, arm);
    ASSERT_EQ(again.rig.count(), arm.rig.count());
    EXPECT_EQ(again.rig.surface.faces, arm.rig.surface.faces);
    EXPECT_EQ(again.rig.surface.colors, arm.rig.surface.colors);
    for (int j = 0; j < arm.rig.count(); ++j) {
      EXPECT_EQ(again.rig.joints[j].name, arm.rig.joints[j].name);
      EXPECT_EQ(again.rig.joints[j].parent, arm.rig.joints[j].parent);
      EXPECT_EQ(again.rig.joints[j].kind,
                arm.rig.joints[j].kind == JointKind::Ball ? JointKind::Hinge : arm.rig.joints[j].kind)
          << "the wrist turns about one axis only";
      EXPECT_LT((again.rig.joints[j].rest - arm.rig.joints[j].rest).norm(), 1e-5f);
    }
    EXPECT_NEAR(std::abs(again.rig.joints[1].axis.z()), 1, 1e-4f);
  }
}

TEST(RigCharacter, HasTracksOfWhatMovesAlone) {
  const Character character = to_character(telescope());
  EXPECT_NO_THROW(check_character(character, "it"));
  ASSERT_EQ(character.animations.size(), 1u);
  std::vector<std::pair<int, TrackPath>> tracks;
  for (const CharacterTrack& track : character.animations[0].tracks)
    tracks.emplace_back(track.node, track.path);
  EXPECT_EQ(tracks, (std::vector<std::pair<int, TrackPath>>{{0, TrackPath::Rotation},
                                                            {0, TrackPath::Translation},
                                                            {1, TrackPath::Rotation},
                                                            {2, TrackPath::Translation}}));
}

TEST(RigCharacter, IsNotMadeOfMetal) {
  const Character file = through_bytes(to_character(telescope()));
  ASSERT_EQ(file.parts[0].material, 0);
  const auto material = nlohmann::json::parse(file.materials.at(0)).at("pbrMetallicRoughness");
  EXPECT_EQ(material.at("metallicFactor"), 0);
}

TEST(RigCharacter, TurnsThroughMoreThanHalfATurn) {
  RiggedMotion arm = test::bending_arm(9);
  for (size_t t = 0; t < 9; ++t)
    arm.motion.poses[t].turns[1] = rotation_from_axis_angle({0, 0, 0.7f * static_cast<float>(t)});
  const Character file = through_bytes(to_character(arm));
  expect_same(from_character(file, 0, 30), arm);
  arm.motion.poses[4].turns[1] = rotation_from_axis_angle({0, 0, 0.7f * 4.5f});  // between two keys
  EXPECT_LT((vertices_at(file, 0, 4.5f / 30).row(150) - posed(arm, 4).row(150)).norm(), 0.1f);
}

TEST(RigCharacter, OfAStillRigIsItsRest) {
  RiggedMotion arm = test::bending_arm(1);
  arm.motion.poses.clear();
  const Character character = through_bytes(to_character(arm));
  EXPECT_TRUE(character.animations.empty());
  const RiggedMotion again = from_character(character, -1, 30);
  ASSERT_EQ(again.motion.poses.size(), 1u);
  EXPECT_LT((posed(again, 0) - arm.rig.surface.vertices).cwiseAbs().maxCoeff(), 1e-5f);
}

// Others' files: centimetres under a scaled node, a skin a part, eight influences, nodes in another pose.
TEST(RigCharacter, ReadsOthersFiles) {
  tests::MadeCharacter options;
  options.nodes_posed = true;
  options.separate_skins = true;
  for (const bool nested : {false, true}) {
    options.nested_scales = nested;
    const Character character = tests::make_character(options);
    const RiggedMotion read = from_character(character, -1, 30);
    EXPECT_GT(read.rig.count(), 20);
    for (const RigJoint& joint : read.rig.joints)
      EXPECT_TRUE(joint.kind == JointKind::Free || joint.kind == JointKind::Ball) << "one pose shows no axis";
    const Points wanted = vertices_at(character, -1, 0);
    const float size = (wanted.colwise().maxCoeff() - wanted.colwise().minCoeff()).norm();
    EXPECT_LT((posed(read, 0) - wanted).rowwise().norm().maxCoeff(), 1e-4f * size);
  }
}

TEST(RigCharacter, LeavesOutWhatCarriesNothing) {
  Character character = to_character(test::bending_arm(3));
  const int end = static_cast<int>(character.nodes.size());
  character.nodes.push_back({"wrist_end", 2, {Vec3(1, 0, 0)}, {}});
  character.skins[0].joints.push_back(end);
  character.skins[0].inverse_bind.push_back(affine(Mat3::Identity(), Vec3(-3, 0, 0)));
  EXPECT_EQ(from_character(character, 0, 30).rig.count(), 3);
  for (int& bone : character.parts[0].joints.reshaped())
    if (bone == 1) bone = 2;  // the elbow has no weight, but carries the wrist
  EXPECT_EQ(from_character(character, 0, 30).rig.count(), 3);
  for (int& bone : character.parts[0].joints.reshaped())
    if (bone == 0) bone = 1;  // the root carries the elbow alone
  const RiggedMotion read = from_character(character, 0, 30);
  EXPECT_LE(read.rig.count(), 2);
}

TEST(RigCharacter, JoinsBonesWithoutACommonOne) {
  Character character = to_character(test::bending_arm(1));
  character.animations.clear();
  character.nodes[1].parent = -1;
  character.nodes[1].local.translation = Vec3(1, 0, 0);
  const RiggedMotion read = from_character(character, -1, 30);
  ASSERT_EQ(read.rig.count(), 4);
  EXPECT_EQ(read.rig.joints[0].name, "root");
  EXPECT_EQ(read.rig.joints[2].parent, 0);
}

TEST(RigCharacter, SaysWhatItCannotRead) {
  Character character = to_character(test::bending_arm(3));
  EXPECT_THROW(from_character(character, 1, 30), Error);
  EXPECT_THROW(from_character(character, 0, 0), Error);
  EXPECT_THROW(from_character(character, 0, 1e9), Error);
  Character scaled = character;
  scaled.animations[0].tracks.push_back(
      {1, TrackPath::Scale, TrackInterpolation::Linear, {0, 0.1f}, {1, 1, 1, 1, 2, 1}});
  EXPECT_THROW(from_character(scaled, 0, 30), Error);
  character.parts[0].skin = -1;
  EXPECT_THROW(from_character(character, 0, 30), Error);
  RiggedMotion arm = test::bending_arm(3);
  arm.motion.poses[1].turns.pop_back();
  EXPECT_THROW(to_character(arm), Error);
  arm = test::bending_arm(3);
  arm.rig.joints[1].parent = 5;
  EXPECT_THROW(to_character(arm), Error);
}

}  // namespace
}  // namespace understudy
