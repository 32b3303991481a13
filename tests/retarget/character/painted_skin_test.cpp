// What a user corrected of a target, joints and weights, is in the exported file.
#include <gtest/gtest.h>

#include "retarget/character/character_export.hpp"
#include "retarget/character/read_character.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::TempFolder;

ExportCost cost_of(const PreparedCharacter& character, const Deformer& screen,
                   const CharacterExportOptions& options = {}) {
  const TempFolder folder;
  return export_character(
      folder.path("a.glb"),
      {{character, screen, {{"walk", 25, made_motion(20, character.target.joints)}}, options}});
}

/// Everything left of the middle goes with the head, by a quarter.
RowMatrix painted(const PreparedCharacter& character) {
  RowMatrix weights = character.weights;
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    if (character.target.mesh.vertices(v, 0) > 0.1f) {
      weights.row(v) *= 0.75f;
      weights(v, Head) += 0.25f;
    }
  return weights;
}

TEST(PaintedSkin, IsInTheFilesOwnWeights) {
  MadeCharacter made;
  made.arms_down_deg = 30;
  made.unit = 0.01f;
  const PreparedCharacter character = prepare_character(make_character(made), nullptr, nullptr);
  const RigDeformer own(character, nullptr);
  const auto screen = own.with_weights(painted(character));
  const Points pose = screen->deform(made_motion(20, character.target.joints)[7]);
  EXPECT_GT((pose - own.deform(made_motion(20, character.target.joints)[7])).rowwise().norm().maxCoeff(),
            0.02f);
  EXPECT_LT(cost_of(character, *screen).largest_mm, 0.2);
}

TEST(PaintedSkin, BonesOfOneJointKeepTheirShares) {
  const PreparedCharacter character = prepare_character(make_character(), nullptr, nullptr);
  const RowMatrix weights = painted(character);
  Character out = character.character;
  apply_painted_weights(character, weights, 4, out);
  const std::vector<int> joint_of = joints_of_nodes(character);
  const CharacterPart &before = character.character.parts[0], &after = out.parts[0];
  int unpainted = 0;
  for (Eigen::Index v = 0; v < after.vertices.rows(); ++v) {
    const auto row = character.surface.map[static_cast<size_t>(v)];
    Eigen::VectorXf sums = Eigen::VectorXf::Zero(kJointCount);
    const CharacterSkin& skin = out.skins[static_cast<size_t>(after.skin)];
    for (Eigen::Index k = 0; k < after.joints.cols(); ++k)
      sums[joint_of[static_cast<size_t>(skin.joints[static_cast<size_t>(after.joints(v, k))])]] +=
          after.weights(v, k);
    EXPECT_LT((sums.transpose() - weights.row(row)).cwiseAbs().maxCoeff(), 1e-4f) << v;
    if (character.target.mesh.vertices(row, 0) > 0.1f) continue;
    ++unpainted;
    EXPECT_EQ(after.joints.row(v).head(before.joints.cols()), before.joints.row(v));
    EXPECT_EQ(after.weights.row(v).head(before.weights.cols()), before.weights.row(v));
  }
  EXPECT_GT(unpainted, 10);
}

TEST(PaintedSkin, PlatesThatFollowedANodeBecomeSkinned) {
  const PreparedCharacter character = prepare_character(make_robot(), nullptr, nullptr);
  const RigDeformer own(character, nullptr);
  EXPECT_LT(cost_of(character, *own.with_weights(painted(character))).largest_mm, 0.2);
}

TEST(MovedJoints, AreInTheFileOnBothSkeletons) {
  const PreparedCharacter character = prepare_character(make_character(), nullptr, nullptr);
  Joints moved = character.target.joints;
  moved.row(LeftElbow) += Vec3(0.04f, 0.02f, -0.01f).transpose();
  moved.row(RightKnee) += Vec3(0, 0.05f, 0).transpose();
  RigDeformer theirs(character, nullptr);
  const Points before = theirs.deform(made_motion(20, moved)[9]);
  theirs.bind(character.target.mesh.vertices, moved);
  EXPECT_GT((before - theirs.deform(made_motion(20, moved)[9])).rowwise().norm().maxCoeff(), 0.002f);
  CharacterExportOptions options;
  options.joints = moved;
  EXPECT_LT(cost_of(character, theirs, options).largest_mm, 0.1);
  BulgingDeformer ours;
  ours.bind(character.target.mesh.vertices, moved);
  options.their_rig = false;
  options.influences = 8;
  EXPECT_LT(cost_of(character, ours, options).mean_mm, 1);
  options.joints.reset();  // what it would be without
  EXPECT_GT(cost_of(character, ours, options).largest_mm, 2);
}

TEST(MovedJoints, WithPaintedWeightsEightInfluencesAndFewerKeysTheFileShowsTheScreen) {
  const PreparedCharacter character = prepare_character(make_character(), nullptr, nullptr);
  CharacterExportOptions options;
  options.joints = character.target.joints;
  options.joints->row(LeftElbow) += Vec3(0.03f, 0.02f, 0).transpose();
  options.influences = 8;
  BulgingDeformer ours;
  ours.bind(character.target.mesh.vertices, *options.joints);
  RigDeformer theirs(character, nullptr);
  theirs.bind(character.target.mesh.vertices, *options.joints);
  for (const bool their_rig : {false, true}) {
    options.their_rig = their_rig;
    const auto screen =
        their_rig ? theirs.with_weights(painted(character)) : ours.with_weights(painted(character));
    options.reduce_mm = 0;
    const ExportCost full = cost_of(character, *screen, options);
    options.reduce_mm = 0.5f;
    const ExportCost fewer = cost_of(character, *screen, options);
    EXPECT_LT(full.largest_mm, 0.2) << their_rig;
    EXPECT_LT(fewer.largest_mm, full.largest_mm + 0.55) << their_rig;
    EXPECT_LT(fewer.keys, full.keys) << their_rig;
  }
}

}  // namespace
}  // namespace understudy::tests
