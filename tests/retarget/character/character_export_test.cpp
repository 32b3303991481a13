#include "retarget/character/character_export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::contains;
using test::error_of;
using test::TempFolder;

float angle_deg(const Joints& joints, int from, int to, const Vec3& wanted) {
  const Vec3 d = (joints.row(to) - joints.row(from)).transpose();
  return std::atan2(d.cross(wanted).norm(), d.dot(wanted)) * 180 / kPi;
}

PreparedCharacter prepared(const MadeCharacter& made, CharacterOptions options = {}) {
  return prepare_character(make_character(made), nullptr, nullptr, options);
}

struct Exported {
  Character file;
  ExportCost cost;
  std::string path;
};

Exported exported(const TempFolder& folder, const PreparedCharacter& character, const Deformer& screen,
                  const std::vector<Pose>& poses, const CharacterExportOptions& options = {}) {
  Exported out;
  out.path = folder.path("out.glb");
  out.cost = export_character(out.path, {{character, screen, {{"walk", 25, poses}}, options}});
  out.file = read_character(out.path);
  return out;
}

/// Millimetres between the file at five times and the screen.
float largest_mm(const Exported& out, const PreparedCharacter& character, const Deformer& screen,
                 const std::vector<Pose>& poses) {
  float largest = 0;
  for (const size_t i :
       {size_t{0}, poses.size() / 4, poses.size() / 2, 3 * poses.size() / 4, poses.size() - 1}) {
    const Points shown = screen.deform(poses[i]);
    const Points seen = vertices_at(out.file, 0, static_cast<float>(i) / 25);
    for (Eigen::Index v = 0; v < seen.rows(); ++v)
      largest = std::max(
          largest, 1000 * (seen.row(v) - shown.row(character.surface.map[static_cast<size_t>(v)])).norm());
  }
  return largest;
}

TEST(RestPose, BringsAnAPoseToTheTPose) {
  MadeCharacter made;
  made.arms_down_deg = 50;
  made.legs_apart_deg = 15;
  const RestPose pose = to_t_pose(made_joints(made));
  for (const auto& [shoulder, elbow, wrist, side] : {std::tuple{LeftShoulder, LeftElbow, LeftWrist, 1.0f},
                                                     {RightShoulder, RightElbow, RightWrist, -1.0f}}) {
    EXPECT_LT(angle_deg(pose.rest, shoulder, elbow, Vec3(side, 0, 0)), 0.1f);
    EXPECT_LT(angle_deg(pose.rest, elbow, wrist, Vec3(side, 0, 0)), 0.1f);
  }
  const Vec3 thigh = (human_rest().row(LeftKnee) - human_rest().row(LeftHip)).transpose();
  EXPECT_LT(angle_deg(pose.rest, LeftHip, LeftKnee, thigh), 0.1f);
  EXPECT_TRUE(bone_lengths(pose.rest).isApprox(bone_lengths(pose.bind), 1e-4f));
  EXPECT_NEAR(pose.largest_deg, 50, 1);
}

TEST(RestPose, LeavesATPoseAlone) {
  const RestPose pose = to_t_pose(made_joints({}));
  EXPECT_EQ(pose.largest_deg, 0);
  EXPECT_EQ(pose.rest, pose.bind);
}

TEST(RestPose, GoesBackToThePoseItCameIn) {
  MadeCharacter made;
  made.arms_down_deg = 40;
  const RestPose pose = to_t_pose(made_joints(made));
  const Joints back = forward_kinematics(pose.rest, pose.back()).joints;
  EXPECT_LT((back - pose.bind).rowwise().norm().maxCoeff(), 1e-4f);
}

TEST(PreparedCharacter, ComesOutAtHumanSizeFacingForward) {
  for (const float unit : {1.0f, 0.01f, 0.0031f}) {
    MadeCharacter made;
    made.unit = unit;
    made.heading_deg = 90;
    const PreparedCharacter character = prepared(made);
    const Points& v = character.target.mesh.vertices;
    EXPECT_NEAR(v.col(1).maxCoeff() - v.col(1).minCoeff(), unit == 0.0031f ? 1.7f : 1.98f, 0.25f) << unit;
    EXPECT_NEAR(v.col(1).minCoeff(), 0, 1e-3f);
    EXPECT_NEAR(heading_of_joints(character.target.joints), 0, 0.01f);
    EXPECT_GT(character.target.joints(LeftWrist, 0), 0.3f);
  }
}

TEST(PreparedCharacter, BonesAreTheJoints) {
  MadeCharacter made;
  made.arms_down_deg = 45;
  made.nodes_posed = true;
  const PreparedCharacter character = prepared(made);
  EXPECT_TRUE(character.rigged);
  Joints want = made_joints(made);
  want.col(1).array() += character.pose.bind(Pelvis, 1) - want(Pelvis, 1);
  EXPECT_LT((character.pose.bind - want).rowwise().norm().maxCoeff(), 0.001f);
  EXPECT_LT(angle_deg(character.target.joints, LeftShoulder, LeftElbow, Vec3::UnitX()), 0.1f);
}

TEST(PreparedCharacter, ABareMeshIsLookedAtByTheNetwork) {
  MadeCharacter made;
  made.rigged = false;
  made.arms_down_deg = 45;
  KnownExtractor before(made_joints(made)), after(made_joints({}));
  EXPECT_TRUE(contains(error_of([&] { prepared(made); }), "the networks may not be used"));
  const PreparedCharacter character = prepare_character(make_character(made), &before, &after);
  EXPECT_FALSE(character.rigged);
  const Points& v = character.target.mesh.vertices;
  EXPECT_GT(v.col(0).maxCoeff() - v.col(0).minCoeff(), 1.3f);  // the arms are out
}

TEST(FoldingTransfer, JointsWithoutABoneDoNotTurn) {
  struct Turning final : MotionTransfer {
    void reset(const Joints&) override {}
    Rotations push(const Extraction&, float) override {
      Rotations out = identity_rotations();
      out[LeftCollar] = out[LeftShoulder] = Eigen::AngleAxisf(0.3f, Vec3::UnitZ()).toRotationMatrix();
      return out;
    }
    std::any memory() const override { return {}; }
    void restore(const std::any&) override {}
    std::string name() const override { return "turning"; }
  };
  BoneMap map;
  map.node.fill(1);
  map.node[LeftCollar] = -1;
  FoldingTransfer folding(std::make_unique<Turning>(), map);
  const Rotations out = folding.push({}, 0.1f);
  EXPECT_NEAR(geodesic_angle(out[LeftCollar], Mat3::Identity()), 0, 1e-4f);
  EXPECT_NEAR(geodesic_angle(out[LeftShoulder], Mat3::Identity()), 0.6f, 1e-4f);
}

class EveryRig : public testing::TestWithParam<MadeCharacter> {};

TEST_P(EveryRig, FileOnItsOwnSkeletonIsWhatTheScreenShows) {
  const TempFolder folder;
  const PreparedCharacter character = prepared(GetParam());
  const RigDeformer screen(character, nullptr);
  const auto poses = made_motion(40, character.target.joints);
  const Exported out = exported(folder, character, screen, poses);
  EXPECT_LT(largest_mm(out, character, screen, poses), 0.1f);
  EXPECT_LT(out.cost.largest_mm, 0.1);
  EXPECT_EQ(out.cost.frames, 40);
  // Opened without playing it stands as it was bound.
  EXPECT_LT((vertices_at(out.file, -1, 0) - character.to_world.apply(character.bind.vertices))
                .rowwise()
                .norm()
                .maxCoeff(),
            1e-4f);
}

MadeCharacter made_like(Naming naming, float arms, float unit, float heading, bool posed) {
  MadeCharacter made;
  made.naming = naming;
  made.arms_down_deg = arms;
  made.unit = unit;
  made.heading_deg = heading;
  made.nodes_posed = posed;
  return made;
}

INSTANTIATE_TEST_SUITE_P(CharacterExport, EveryRig,
                         testing::Values(made_like(Naming::Mixamo, 0, 1, 0, false),
                                         made_like(Naming::Rigify, 50, 1, 0, false),
                                         made_like(Naming::Vrm, 30, 0.01f, 180, false),
                                         made_like(Naming::Unreal, 45, 0.01f, 90, true),
                                         made_like(Naming::None, 0, 0.0031f, 30, false)));

TEST(CharacterExport, FingersStayAsTheyAreOnTheHand) {
  const TempFolder folder;
  const PreparedCharacter character = prepared({});
  const RigDeformer screen(character, nullptr);
  const Exported out = exported(folder, character, screen, made_motion(5, character.target.joints));
  for (const auto& track : out.file.animations[0].tracks)
    EXPECT_FALSE(contains(out.file.nodes[static_cast<size_t>(track.node)].name, "Index"));
  int translated = 0;
  for (const auto& track : out.file.animations[0].tracks) translated += track.path == TrackPath::Translation;
  EXPECT_EQ(translated, 1);  // the hips alone
}

TEST(CharacterExport, KeepsPartsMaterialsPicturesAndNames) {
  const TempFolder folder;
  for (const bool theirs : {true, false}) {
    const PreparedCharacter character = prepared({});
    BulgingDeformer ours;
    ours.bind(character.target.mesh.vertices, character.target.joints);
    const RigDeformer rig(character, nullptr);
    CharacterExportOptions options;
    options.their_rig = theirs;
    const Exported out = exported(folder, character, theirs ? static_cast<const Deformer&>(rig) : ours,
                                  made_motion(3, character.target.joints), options);
    ASSERT_EQ(out.file.parts.size(), 2u);
    EXPECT_EQ(out.file.parts[0].name, "Upper");
    EXPECT_EQ(out.file.parts[1].name, "Lower");
    EXPECT_EQ(out.file.materials, character.character.materials);
    EXPECT_EQ(out.file.images[0].bytes, made_picture());
    EXPECT_LT((out.file.parts[0].uvs[0] - character.character.parts[0].uvs[0]).norm(), 1e-5f);
    EXPECT_NEAR(out.file.parts[1].colors(3, 1), 0.5f, 1e-6f);
  }
}

TEST(CharacterExport, OurRigCostsWhatFourInfluencesLeaveOut) {
  const TempFolder folder;
  MadeCharacter made;
  made.arms_down_deg = 45;
  const PreparedCharacter character = prepared(made);
  BulgingDeformer screen;
  screen.bind(character.target.mesh.vertices, character.target.joints);
  const auto poses = made_motion(30, character.target.joints);
  CharacterExportOptions options;
  options.their_rig = false;
  const double four = exported(folder, character, screen, poses, options).cost.mean_mm;
  options.influences = 8;
  const Exported eight = exported(folder, character, screen, poses, options);
  EXPECT_EQ(eight.file.parts[0].joints.cols(), 8);
  EXPECT_LT(eight.cost.mean_mm, 0.5 * four + 1e-6);
  EXPECT_EQ(eight.file.nodes[LeftElbow].name, "left_elbow");
}

TEST(RigDeformer, TakesOffsetsWhereItsWeightsAreThoseTheyWereMadeFor) {
  PreparedCharacter character = prepared({});
  auto bulging = std::make_shared<BulgingDeformer>(0.03f);
  bulging->bind(character.target.mesh.vertices, character.target.joints);
  const Eigen::Index half = character.weights.rows() / 2;
  character.weights = bulging->weights();
  for (Eigen::Index v = half; v < character.weights.rows(); ++v)
    character.weights.row(v) = Eigen::RowVectorXf::Unit(kJointCount, Head);
  RigDeformer rig(character, std::make_shared<BulgingDeformer>(0.03f));
  rig.bind(character.target.mesh.vertices, character.target.joints);
  const Pose pose = made_motion(20, character.target.joints)[15];
  const Points theirs = rig.offsets(pose), all = bulging->offsets(pose);
  ASSERT_GT(all.norm(), 0.01f);
  EXPECT_EQ(theirs.topRows(half), all.topRows(half));
  for (Eigen::Index v = half; v < all.rows(); ++v)
    if (bulging->weights()(v, Head) < 0.5f) EXPECT_EQ(theirs.row(v).norm(), 0) << v;
}

TEST(CharacterExport, ItsOwnClipsStayBesideMorphTargets) {
  const TempFolder folder;
  PreparedCharacter character = prepared({});
  CharacterAnimation nod;
  nod.name = "nod";
  CharacterTrack track;
  track.node = character.map.node[Head];
  track.path = TrackPath::Rotation;
  track.times = {0, 1};
  track.values = {0, 0, 0, 1, 0.1f, 0, 0, 0.995f};
  nod.tracks = {track};
  character.character.animations = {nod};
  auto bulging = std::make_shared<BulgingDeformer>(0.03f);
  RigDeformer rig(character, bulging);
  rig.bind(character.target.mesh.vertices, character.target.joints);
  CharacterExportOptions options;
  options.shapes = 3;
  options.keep_clips = true;
  const Exported out = exported(folder, character, rig, made_motion(10, character.target.joints), options);
  ASSERT_EQ(out.file.animations.size(), 2u);
  EXPECT_EQ(out.file.animations[1].name, "nod");
  EXPECT_GT(out.file.parts[0].shapes.size(), 0u);
}

TEST(CharacterExport, ShapesBringTheOffsetsBack) {
  for (const bool theirs : {true, false}) {
    const TempFolder folder;
    MadeCharacter made;
    made.arms_down_deg = 45;
    made.unit = 0.01f;
    const PreparedCharacter character = prepared(made);
    auto bulging = std::make_shared<BulgingDeformer>(0.03f);
    RigDeformer rig(character, bulging);
    rig.bind(character.target.mesh.vertices, character.target.joints);
    bulging->bind(character.target.mesh.vertices, character.target.joints);
    const Deformer& screen = theirs ? static_cast<const Deformer&>(rig) : *bulging;
    const auto poses = made_motion(40, character.target.joints);
    CharacterExportOptions options;
    options.their_rig = theirs;
    options.influences = 8;
    const double without = exported(folder, character, screen, poses, options).cost.mean_mm;
    options.shapes = 4;
    const Exported with = exported(folder, character, screen, poses, options);
    EXPECT_LT(with.cost.mean_mm, 0.15 * without) << theirs;
    EXPECT_GE(with.file.parts[0].shapes.size(), 2u);  // no more than 4, and none that would be empty
    EXPECT_LE(with.file.parts[0].shapes.size(), 4u);
    for (const auto& track : with.file.animations[0].tracks) {
      if (track.path != TrackPath::Shapes) continue;
      EXPECT_GE(*std::min_element(track.values.begin(), track.values.end()), 0);
      EXPECT_LE(*std::max_element(track.values.begin(), track.values.end()), 1);
    }
  }
}

TEST(CharacterExport, FewerKeysStayWithinTheStatedError) {
  const TempFolder folder;
  const PreparedCharacter character = prepared({});
  const RigDeformer screen(character, nullptr);
  const auto poses = made_motion(60, character.target.joints);
  CharacterExportOptions options;
  const Exported all = exported(folder, character, screen, poses, options);
  options.reduce_mm = 3;
  const Exported few = exported(folder, character, screen, poses, options);
  EXPECT_LT(few.cost.keys, all.cost.keys / 2);
  EXPECT_LE(few.cost.largest_mm, 3.1);
  EXPECT_LT(few.cost.bytes, all.cost.bytes);
}

TEST(CharacterExport, InPlaceStaysAndTheTPoseComesFirst) {
  const TempFolder folder;
  const PreparedCharacter character = prepared({});
  const RigDeformer screen(character, nullptr);
  const auto poses = made_motion(50, character.target.joints);
  CharacterExportOptions options;
  options.in_place = options.t_pose_clip = true;
  const std::string path = folder.path("two.gltf");
  export_character(path, {{character, screen, {{"walk", 25, poses}, {"walk", 25, poses}}, options}});
  const Character file = read_character(path);
  ASSERT_EQ(file.animations.size(), 3u);
  EXPECT_EQ(file.animations[0].name, "T-pose");
  EXPECT_EQ(file.animations[2].name, "walk 2");
  const Points start = vertices_at(file, 1, 0), end = vertices_at(file, 1, 49.0f / 25);
  EXPECT_LT((start.colwise().mean() - end.colwise().mean()).norm(), 0.15f);
  const Points rest = vertices_at(file, 0, 0);
  EXPECT_GT(rest.col(0).maxCoeff() - rest.col(0).minCoeff(), 1.3f);
}

/// Poses that walk two metres forward and one aside.
std::vector<Pose> walking_away(const Joints& rest) {
  std::vector<Pose> poses = made_motion(20, rest);
  for (size_t i = 0; i < poses.size(); ++i) poses[i].root += Vec3(0.05f, 0, 0.1f) * static_cast<float>(i);
  return poses;
}

int node_called(const Character& file, const std::string& name) {
  for (size_t n = 0; n < file.nodes.size(); ++n)
    if (file.nodes[n].name == name) return static_cast<int>(n);
  return -1;
}

/// Metres over the floor between two nodes of the file when it plays: the greatest.
float farthest_over_floor(const Exported& out, int a, int b) {
  float farthest = 0;
  for (int i = 0; i < 20; ++i) {
    const PosedNodes posed = nodes_at(out.file, 0, static_cast<float>(i) / 25);
    Vec3 between =
        (posed.world[static_cast<size_t>(a)] - posed.world[static_cast<size_t>(b)]).topRightCorner<3, 1>();
    between.y() = 0;
    farthest = std::max(farthest, between.norm());
  }
  return farthest;
}

TEST_P(EveryRig, ARootBoneCarriesThePath) {
  const TempFolder folder;
  const PreparedCharacter character = prepared(GetParam());
  const RigDeformer screen(character, nullptr);
  const auto poses = walking_away(character.target.joints);
  CharacterExportOptions options;
  options.root_motion = true;
  const Exported out = exported(folder, character, screen, poses, options);
  EXPECT_LT(largest_mm(out, character, screen, poses), 0.1f) << "it plays as without";
  const auto pelvis = std::find(character.driver.begin(), character.driver.end(), static_cast<int>(Pelvis));
  ASSERT_NE(pelvis, character.driver.end());
  const int hips = node_called(
      out.file, character.character.nodes[static_cast<size_t>(pelvis - character.driver.begin())].name);
  const int root = node_called(out.file, "Root");
  ASSERT_GE(root, 0);
  EXPECT_LT(farthest_over_floor(out, hips, root), 0.4f) << "the root is below the hips all the way";
  for (const CharacterSkin& skin : out.file.skins)
    EXPECT_NE(std::find(skin.joints.begin(), skin.joints.end(), root), skin.joints.end()) << "a bone";
}

TEST(CharacterExport, ARootBoneThatTheRigHasCarriesThePath) {
  const TempFolder folder;
  Character made = make_character();
  made.skins[0].joints.push_back(0);
  made.skins[0].inverse_bind.push_back(Mat4::Identity());
  const std::string name = made.nodes[0].name;
  const PreparedCharacter character = prepare_character(std::move(made), nullptr, nullptr);
  ASSERT_EQ(character.driver[0], -1);
  const RigDeformer screen(character, nullptr);
  const auto poses = walking_away(character.target.joints);
  CharacterExportOptions options;
  options.root_motion = true;
  const Exported out = exported(folder, character, screen, poses, options);
  EXPECT_LT(largest_mm(out, character, screen, poses), 0.1f);
  EXPECT_EQ(node_called(out.file, "Root"), -1);
  const int root = node_called(out.file, name);
  const auto& tracks = out.file.animations.at(0).tracks;
  EXPECT_TRUE(std::any_of(tracks.begin(), tracks.end(), [&](const CharacterTrack& track) {
    return track.node == root && track.path == TrackPath::Translation;
  }));
}

TEST(CharacterExport, The22JointsWithARootBoneOpenAgainAsTheSameShape) {
  const TempFolder folder;
  const PreparedCharacter character = prepared({});
  BulgingDeformer screen;
  screen.bind(character.target.mesh.vertices, character.target.joints);
  const auto poses = walking_away(character.target.joints);
  CharacterExportOptions options;
  options.their_rig = false, options.root_motion = true, options.influences = 8;
  const Exported out = exported(folder, character, screen, poses, options);
  const Exported plain = [&] {
    options.root_motion = false;
    return exported(folder, character, screen, poses, options);
  }();
  EXPECT_NEAR(out.cost.largest_mm, plain.cost.largest_mm, 0.01);
  EXPECT_LT(farthest_over_floor(out, node_called(out.file, "pelvis"), node_called(out.file, "Root")), 0.4f);
  const PreparedCharacter again = prepare_character(out.file, nullptr, nullptr);
  EXPECT_LT((again.target.joints - character.target.joints).rowwise().norm().maxCoeff(), 1e-3f);
}

TEST(CharacterExport, RotationsTurnTheShortWay) {
  const PreparedCharacter character = prepared({});
  const RigDeformer screen(character, nullptr);
  CharacterClip spin{"spin", 25, std::vector<Pose>(60)};
  for (size_t i = 0; i < spin.poses.size(); ++i)
    spin.poses[i].local[Pelvis] = rotation_about_y(0.2f * static_cast<float>(i));
  const Character out = animated_character({{character, screen, {spin}, {}}});
  for (const auto& track : out.animations[0].tracks) {
    if (track.path != TrackPath::Rotation) continue;
    for (size_t i = 4; i < track.values.size(); i += 4)
      EXPECT_GT(Eigen::Map<const Eigen::Vector4f>(&track.values[i])
                    .dot(Eigen::Map<const Eigen::Vector4f>(&track.values[i - 4])),
                0);
  }
}

TEST(CharacterExport, ItsFileOpensAgainAsTheSameCharacter) {
  const TempFolder folder;
  MadeCharacter made;
  made.arms_down_deg = 40;
  made.heading_deg = 90;
  const PreparedCharacter first = prepared(made);
  const RigDeformer screen(first, nullptr);
  const Exported out = exported(folder, first, screen, made_motion(10, first.target.joints));
  const PreparedCharacter second = prepare_character(out.file, nullptr, nullptr);
  EXPECT_LT((second.target.joints - first.target.joints).rowwise().norm().maxCoeff(), 1e-3f);
  EXPECT_LT((second.target.mesh.vertices - first.target.mesh.vertices).rowwise().norm().maxCoeff(), 1e-3f);
}

/// How far the vertices of b are from those of a at most: rounding may weld a few more of them.
float farthest_from(const Points& a, const Points& b) {
  float farthest = 0;
  for (Eigen::Index i = 0; i < b.rows(); ++i)
    farthest = std::max(farthest, (a.rowwise() - b.row(i)).rowwise().norm().minCoeff());
  return farthest;
}

TEST(CharacterExport, ABareShapesFileOpensAgainAsTheSameShapeAndAnimation) {
  const TempFolder folder;
  MadeCharacter made;
  made.rigged = false;
  made.arms_down_deg = 3;  // near enough to the T-pose for joints that were seen
  made.legs_apart_deg = 2;
  KnownExtractor known(made_joints(made));
  const PreparedCharacter first = prepare_character(make_character(made), &known, &known);
  BulgingDeformer screen;
  screen.bind(first.target.mesh.vertices, first.target.joints);
  CharacterExportOptions options;
  options.their_rig = false;
  const auto poses = made_motion(10, first.target.joints);
  const Exported out = exported(folder, first, screen, poses, options);
  const PreparedCharacter second = prepare_character(out.file, nullptr, nullptr);
  ASSERT_TRUE(second.rigged);
  EXPECT_LT((second.target.joints - first.target.joints).rowwise().norm().maxCoeff(), 1e-4f);
  EXPECT_LT(farthest_from(first.target.mesh.vertices, second.target.mesh.vertices), 1e-4f);
  const RigDeformer again(second, nullptr);
  EXPECT_LT(largest_mm(out, second, again, poses), 0.1f);
}

TEST(PreparedCharacter, IsLedByAPelvisBetweenTheHipsWhereverTheRigHasItsBone) {
  const PreparedCharacter usual = prepared({});
  Character odd = make_character({});
  const int hips = usual.map.node[Pelvis];
  const Vec3 moved(0, -0.05f, 0.12f);  // in front of the belly
  odd.nodes[static_cast<size_t>(hips)].local.translation += moved;
  for (auto& node : odd.nodes)
    if (node.parent == hips) node.local.translation -= moved;
  for (auto& skin : odd.skins)
    for (size_t j = 0; j < skin.joints.size(); ++j)
      if (skin.joints[j] == hips) skin.inverse_bind[j].topRightCorner<3, 1>() -= moved;
  const PreparedCharacter character = prepare_character(odd, nullptr, nullptr);
  EXPECT_LT((character.target.joints - usual.target.joints).rowwise().norm().maxCoeff(), 0.03f);
  // It performs as it would with its bone in place.
  const auto poses = made_motion(12, usual.target.joints);
  auto same = poses;
  for (auto& pose : same)
    pose.root += pose.local[Pelvis] *
                 (character.target.joints.row(Pelvis) - usual.target.joints.row(Pelvis)).transpose();
  const RigDeformer screen(character, nullptr), before(usual, nullptr);
  EXPECT_LT((screen.deform(same[7]) - before.deform(poses[7])).rowwise().norm().maxCoeff(), 2e-4f);
  const TempFolder folder;
  const Exported out = exported(folder, character, screen, same);
  EXPECT_LT(largest_mm(out, character, screen, same), 0.1f);
}

TEST(CharacterExport, ARobotOfHardPartsStaysHard) {
  const TempFolder folder;
  const PreparedCharacter character = prepare_character(make_robot(), nullptr, nullptr);
  ASSERT_TRUE(character.rigged);
  const RigDeformer screen(character, nullptr);
  const auto poses = made_motion(20, character.target.joints);
  const Exported out = exported(folder, character, screen, poses);
  EXPECT_LT(largest_mm(out, character, screen, poses), 0.1f);
  const Points before = vertices_at(out.file, 0, 0), after = vertices_at(out.file, 0, 0.6f);
  for (Eigen::Index v = 0; v < before.rows(); v += 4)
    EXPECT_NEAR((before.row(v) - before.row(v + 1)).norm(), (after.row(v) - after.row(v + 1)).norm(), 1e-5f);
}

TEST(CharacterExport, ABarePointCloudIsSkinnedPoints) {
  const TempFolder folder;
  MadeCharacter made;
  made.rigged = false;
  const Character body = make_character(made);
  Mesh cloud;
  cloud.vertices = posed_vertices(body, body.world());
  KnownExtractor known(made_joints(made));
  const PreparedCharacter character = prepare_character(character_of_mesh(cloud, "cloud"), &known, &known);
  BulgingDeformer screen;
  screen.bind(character.target.mesh.vertices, character.target.joints);
  CharacterExportOptions options;
  options.their_rig = false;
  const Exported out = exported(folder, character, screen, made_motion(5, character.target.joints), options);
  EXPECT_EQ(out.file.parts[0].faces.rows(), 0);
  EXPECT_EQ(out.file.parts[0].skin, 0);
  EXPECT_LT(out.cost.mean_mm, 5);
}

TEST(CharacterExport, RefusesWhatItCannotDo) {
  const TempFolder folder;
  const PreparedCharacter character = prepared({});
  const RigDeformer screen(character, nullptr);
  auto poses = made_motion(3, character.target.joints);
  const auto complaint = [&](const std::string& path, const std::vector<CharacterClip>& clips,
                             const CharacterExportOptions& options = {}) {
    return error_of([&] { export_character(path, {{character, screen, clips, options}}); });
  };
  EXPECT_TRUE(contains(complaint(folder.path("a.glb"), {}), "no motion"));
  EXPECT_TRUE(contains(complaint(folder.path("no/a.glb"), {{"walk", 25, poses}}), "cannot be written"));
  poses[1].root.x() = NAN;
  EXPECT_TRUE(contains(complaint(folder.path("a.glb"), {{"walk", 25, poses}}), "not finite"));
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.glb")));
}

TEST(KeyReduction, KeepsWhatCannotBeGuessed) {
  CharacterTrack track{0, TrackPath::Translation, TrackInterpolation::Linear, {}, {}};
  for (int i = 0; i <= 10; ++i) {
    track.times.push_back(static_cast<float>(i));
    track.values.insert(track.values.end(), {i == 5 ? 1.0f : 0.0f, 0, 0});
  }
  const CharacterTrack few = reduced(track, 0.01f);
  EXPECT_EQ(few.times, (std::vector<float>{0, 4, 5, 6, 10}));
  track.values.assign(track.values.size(), 0);
  EXPECT_EQ(reduced(track, 0.01f).times.size(), 1u);
}

TEST(KeyReduction, KeepsKeysOfTurnsThatAChordWouldMiss) {
  const auto keys = [](float angle) {
    CharacterTrack track{0, TrackPath::Rotation, TrackInterpolation::Linear, {}, {}};
    for (int i = 0; i <= 10; ++i) {
      const Eigen::Quaternionf q(Eigen::AngleAxisf(angle * static_cast<float>(i) / 10, Vec3::UnitX()));
      track.times.push_back(static_cast<float>(i));
      track.values.insert(track.values.end(), q.coeffs().data(), q.coeffs().data() + 4);
    }
    return reduced(track, 0.005f).times.size();
  };
  EXPECT_EQ(keys(0.4f), 2u);
  EXPECT_GT(keys(2.5f), 2u);
}

}  // namespace
}  // namespace understudy::tests
