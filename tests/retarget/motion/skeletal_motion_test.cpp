#include "retarget/motion/skeletal_motion.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/character/character_export.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion/bvh.hpp"
#include "retarget/motion/clip.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "tests/retarget/formats/support.hpp"
#include "tests/retarget/motion/made_motion.hpp"

namespace understudy::tests {
namespace {

using test::contains;
using test::error_of;
using test::TempFolder;

constexpr int kFrames = 40;

/// What a motion should give: joints and rotations of these poses.
struct Truth {
  Joints rest = made_joints({});
  std::vector<Pose> poses = made_motion(kFrames, rest);
  PosedSkeleton at(size_t t) const { return forward_kinematics(rest, poses[t]); }
};

/// Largest distance, mm, after the least-squares shift that `free` axes are given.
float largest_mm(const SkeletalMotion& motion, const Truth& truth, const Vec3& shift = Vec3::Zero()) {
  float largest = 0;
  for (size_t t = 0; t < truth.poses.size(); ++t) {
    const Joints seen = motion.skeleton(static_cast<int64_t>(t)).joints;
    for (int j = 0; j < kJointCount; ++j)
      largest =
          std::max(largest, 1000 * (seen.row(j) + shift.transpose() - truth.at(t).joints.row(j)).norm());
  }
  return largest;
}

float largest_deg(const SkeletalMotion& motion, const Truth& truth) {
  float largest = 0;
  for (size_t t = 0; t < truth.poses.size(); ++t) {
    const Rotations seen = *motion.skeleton(static_cast<int64_t>(t)).global;
    for (size_t j = 0; j < kJointCount; ++j)
      largest = std::max(largest, geodesic_angle(seen[j], truth.at(t).global[j]) * 180 / kPi);
  }
  return largest;
}

/// Height is up to the soles of bones, which nobody knows.
Vec3 height_shift(const SkeletalMotion& motion, const Truth& truth) {
  return {0, truth.at(0).joints(Pelvis, 1) - motion.skeleton(0).joints(Pelvis, 1), 0};
}

void expect_same(const SkeletalMotion& motion, const Truth& truth) {
  ASSERT_EQ(motion.count(), kFrames);
  const Vec3 shift = height_shift(motion, truth);
  EXPECT_LT(std::abs(shift.y()), 0.08f);
  EXPECT_LT(largest_mm(motion, truth, shift), 1);
  EXPECT_LT(largest_deg(motion, truth), 0.1f);
}

SkeletalMotion motion_of(const MadeBvh& made, const Truth& truth, const SkeletalMotionOptions& options = {}) {
  return {parse_bvh(made_bvh(made, truth.rest, truth.poses), "made.bvh"), options};
}

TEST(SkeletalMotion, ReadsABvhInMetres) {
  const Truth truth;
  const SkeletalMotion motion = motion_of({}, truth);
  EXPECT_DOUBLE_EQ(motion.fps(), 120);
  EXPECT_EQ(motion.map().count(), kJointCount);
  EXPECT_TRUE(motion.skeleton(0).exact);
  expect_same(motion, truth);
}

TEST(SkeletalMotion, ReadsABvhInCentimetresWithZUp) {
  const Truth truth;
  MadeBvh made;
  made.unit = 0.01f;
  made.z_up = true;
  made.order = "XYZ";
  expect_same(motion_of(made, truth), truth);
}

TEST(SkeletalMotion, SeesAMotionWithZUpOnOffsetsWithYUp) {
  const Truth truth;
  MadeBvh made;
  made.only_motion_z_up = true;
  made.naming = Naming::Mixamo;
  expect_same(motion_of(made, truth), truth);
  SkeletalMotionOptions options;
  options.import.up = "z";
  expect_same(motion_of(made, truth, options), truth);
}

TEST(SkeletalMotion, TakesAFirstFrameInTPose) {
  Truth truth;
  truth.poses[0].local = identity_rotations();
  // Offsets along one axis, as some programs write them: the T-pose is in the turns of the first frame.
  Character person = parse_bvh(made_bvh({}, truth.rest, truth.poses), "made.bvh");
  std::vector<Mat3> twist(person.nodes.size(), Mat3::Identity());
  for (size_t n = 1; n < person.nodes.size(); ++n) {
    const Vec3 offset = person.nodes[n].local.translation;
    const auto p = static_cast<size_t>(person.nodes[n].parent);
    if (person.nodes[p].name == made_name(Naming::Cmu, LeftShoulder) ||
        person.nodes[p].name == made_name(Naming::Cmu, RightShoulder))
      twist[p] = rotation_between(offset, Vec3(0, offset.norm(), 0.01f));  // arms up
  }
  for (size_t n = 0; n < person.nodes.size(); ++n) {
    const int p = person.nodes[n].parent;
    if (p >= 0)
      person.nodes[n].local.translation = twist[static_cast<size_t>(p)] * person.nodes[n].local.translation;
  }
  for (auto& track : person.animations[0].tracks) {
    const auto n = static_cast<size_t>(track.node);
    const int p = person.nodes[n].parent;
    const Eigen::Quaternionf before(p < 0 ? Mat3(Mat3::Identity()) : twist[static_cast<size_t>(p)]),
        after(Mat3(twist[n].transpose()));
    for (size_t k = 0; track.path == TrackPath::Rotation && k < track.times.size(); ++k) {
      Eigen::Map<Eigen::Vector4f> value(track.values.data() + 4 * k);
      value = (before * Eigen::Quaternionf(value) * after).coeffs();
    }
  }
  const SkeletalMotion motion(person, {});
  bool said = false;
  for (const auto& note : motion.notes())
    said = said || contains(note, "first frame is taken for the T-pose");
  EXPECT_TRUE(said);
  expect_same(motion, truth);
}

TEST(SkeletalMotion, StandsOnTheFloor) {
  Truth truth;
  for (Pose& pose : truth.poses) pose.root.y() += 3;
  const SkeletalMotion motion = motion_of({}, truth);
  float lowest = 10;
  for (int64_t t = 0; t < kFrames; ++t) lowest = std::min(lowest, *motion.skeleton(t).sole_height);
  EXPECT_NEAR(lowest, 0, 0.03);
  SkeletalMotionOptions options;
  options.import.floor = 2.5f;
  const SkeletalMotion higher = motion_of({}, truth, options);
  EXPECT_NEAR(higher.skeleton(0).joints(Pelvis, 1), truth.at(0).joints(Pelvis, 1) - 2.5f, 1e-3);
}

TEST(SkeletalMotion, FixesJointsThatTheRigLacksToThoseAbove) {
  Truth truth;
  for (Pose& pose : truth.poses) {
    pose.local[Spine2] = pose.local[LeftCollar] = Mat3::Identity();
    pose.local[Spine3] = Mat3::Identity();
  }
  SkeletalMotionOptions options;
  options.bones = {{"spine2", ""}, {"left_collar", ""}, {"left_foot", ""}};
  const SkeletalMotion motion = motion_of({}, truth, options);
  EXPECT_EQ(motion.map().count(), kJointCount - 3);
  const Extraction seen = motion.skeleton(7);
  EXPECT_EQ(seen.confidence[Spine2], 0.5f);
  EXPECT_EQ(seen.confidence[Spine1], 1);
  const float shift = height_shift(motion, truth).y();
  for (const int j : {Spine2, LeftCollar, LeftFoot}) {
    const Vec3 off = (seen.joints.row(j) - truth.at(7).joints.row(j)).transpose();
    EXPECT_LT((off + Vec3(0, shift, 0)).norm(), j == Spine2 ? 0.02f : 0.15f)
        << kJointNames[static_cast<size_t>(j)];
  }
  EXPECT_LT(geodesic_angle((*seen.global)[LeftFoot], (*seen.global)[LeftAnkle]), 1e-3f);
}

TEST(SkeletalMotion, RefusesWhatIsNoPerson) {
  const char* const snake =
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT b\n{\nOFFSET 1 0 "
      "0\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n";
  const std::string said = error_of([&] { SkeletalMotion(parse_bvh(snake, "snake.bvh"), {}); });
  EXPECT_TRUE(contains(said, "snake: only ")) << said;
  EXPECT_TRUE(contains(error_of([&] { SkeletalMotion(make_character(), {}); }), "has no animation"));
  SkeletalMotionOptions options;
  options.clip = "dance";
  EXPECT_TRUE(
      contains(error_of([&] { motion_of({}, Truth(), options); }), "has no animation 'dance', only 1 made"));
  options.clip = "";
  options.bones = {{"left_wrist", "nothing"}};
  EXPECT_TRUE(contains(error_of([&] { motion_of({}, Truth(), options); }), "'nothing'"));
}

/// A character that has been exported, opened again.
struct RoundTrip {
  explicit RoundTrip(const MadeCharacter& made, const CharacterExportOptions& options = {}, double fps = 25)
      : prepared(prepare_character(make_character(made), nullptr, nullptr)) {
    truth.rest = prepared.target.joints;
    truth.poses = made_motion(kFrames, truth.rest);
    BulgingDeformer plain;
    plain.bind(prepared.target.mesh.vertices, prepared.target.joints);
    const RigDeformer rig(prepared, nullptr);
    const Deformer& screen = options.their_rig ? static_cast<const Deformer&>(rig) : plain;
    file = folder.path("out.glb");
    export_character(file, {{prepared, screen, {{"walk", fps, truth.poses}}, options}});
  }
  SkeletalMotion opened(const SkeletalMotionOptions& options = {}) const {
    return {*read_motion(file), options};
  }

  TempFolder folder;
  PreparedCharacter prepared;
  Truth truth;
  std::string file;
};

TEST(SkeletalMotion, GivesBackWhatWasExportedOnTheirRig) {
  MadeCharacter made;
  made.arms_down_deg = 45;
  made.legs_apart_deg = 8;
  made.unit = 0.01f;
  made.heading_deg = 180;
  for (const Naming naming : {Naming::Mixamo, Naming::Rigify}) {
    made.naming = naming;
    const RoundTrip trip(made);
    const SkeletalMotion motion = trip.opened();
    ASSERT_EQ(motion.count(), kFrames);
    EXPECT_DOUBLE_EQ(motion.fps(), 25);
    EXPECT_LT(largest_mm(motion, trip.truth), 1);
    EXPECT_LT(largest_deg(motion, trip.truth), 0.2f);
  }
}

TEST(SkeletalMotion, GivesBackWhatWasExportedOnOurRig) {
  MadeCharacter made;
  made.arms_down_deg = 45;
  CharacterExportOptions options;
  options.their_rig = false;
  options.t_pose_clip = true;
  const RoundTrip trip(made, options, 29.97);
  const SkeletalMotion motion = trip.opened();
  ASSERT_EQ(motion.count(), kFrames);  // the longest clip, not the T-pose
  EXPECT_NEAR(motion.fps(), 29.97, 1e-3);
  EXPECT_LT(largest_mm(motion, trip.truth), 1);
  EXPECT_LT(largest_deg(motion, trip.truth), 0.2f);
  SkeletalMotionOptions first;
  first.clip = "1";
  EXPECT_EQ(trip.opened(first).count(), 1);
}

TEST(SkeletalMotion, KnowsTheRateOfReducedKeys) {
  CharacterExportOptions options;
  options.reduce_mm = 5;
  const RoundTrip trip({}, options, 50);
  const SkeletalMotion motion = trip.opened();
  EXPECT_DOUBLE_EQ(motion.fps(), 50);
  EXPECT_EQ(motion.count(), kFrames);
  EXPECT_LT(largest_mm(motion, trip.truth), 10);
}

TEST(SkeletalMotion, ResamplesWhenAsked) {
  const RoundTrip trip({});
  SkeletalMotionOptions options;
  options.fps = 50;
  const SkeletalMotion motion = trip.opened(options);
  EXPECT_EQ(motion.count(), 2 * kFrames - 1);
  EXPECT_LT((motion.skeleton(20).joints - trip.truth.at(10).joints).cwiseAbs().maxCoeff(), 1e-3f);
}

TEST(SkeletalMotion, RefusesAnimationsOfMoreFramesThanADayHas) {
  const Truth truth;
  for (const double last : {1e6, 1e18, 3e38}) {
    Character character = parse_bvh(made_bvh({}, truth.rest, truth.poses), "made.bvh");
    for (auto& track : character.animations[0].tracks) track.times.back() = static_cast<float>(last);
    character.file = "long.glb";
    const std::string complaint = error_of([&] { SkeletalMotion(character, {}); });
    EXPECT_TRUE(contains(complaint, "long.glb: its animation '")) << complaint;
    EXPECT_TRUE(contains(complaint, "only 5184000 frames are read")) << complaint;
  }
  MadeBvh slow;
  slow.fps = 1e-7;
  EXPECT_TRUE(contains(error_of([&] { motion_of(slow, truth); }), "a frame time of"));
  SkeletalMotionOptions fast;
  fast.fps = 1e9;
  EXPECT_TRUE(contains(error_of([&] { motion_of({}, truth, fast); }), "only 5184000 frames are read"));
}

TEST(SkeletalMotion, KnowsTheWayBackToTheFile) {
  MadeBvh made;
  made.unit = 0.01f;
  made.z_up = true;
  const Truth truth;
  const Character file = parse_bvh(made_bvh(made, truth.rest, truth.poses), "made.bvh");
  const SkeletalMotion motion(file, {});
  const Eigen::Matrix4d back = motion.to_file();
  const Vec3 hips = motion.skeleton(7).joints.row(LeftKnee).transpose();
  const auto node = static_cast<size_t>(motion.map().node[LeftKnee]);
  const Vec3 own = nodes_at(file, 0, 7 / 120.0f).world[node].topRightCorner<3, 1>();
  EXPECT_LT(((back * hips.cast<double>().homogeneous()).head<3>() - own.cast<double>()).norm(), 0.01) << own;
}

TEST(SkeletalMotion, ShowsTheSkinOrTheBones) {
  const RoundTrip trip({});
  const SkeletalMotion skinned = trip.opened();
  const Mesh skin = skinned.surface(5);
  EXPECT_EQ(skin.vertices.rows(), trip.prepared.surface.mesh.vertices.rows());
  const RigDeformer rig(trip.prepared, nullptr);
  EXPECT_NEAR(skin.vertices.col(1).maxCoeff(), rig.deform(trip.truth.poses[5]).col(1).maxCoeff(), 2e-3);
  const Truth truth;
  const SkeletalMotion bare = motion_of({}, truth);
  const Mesh bones = bare.surface(5);
  EXPECT_GT(bones.faces.rows(), 8 * 20);
  const Vec3 head = bare.skeleton(5).joints.row(Head).transpose();
  EXPECT_LT((bones.vertices.rowwise() - head.transpose()).rowwise().norm().minCoeff(), 1e-4f);
}

TEST(SkeletalMotion, ReadsAnAmassMotionWithoutABody) {
  Truth truth;
  truth.rest = human_rest() * (0.8f / leg_length(human_rest()));
  const Mat3 z_up = rotation_from_axis_angle(Vec3(kPi / 2, 0, 0));
  NpyArray poses{{kFrames, 156}, std::vector<float>(kFrames * 156, 0.0f), ""}, trans{{kFrames, 3}, {}, ""};
  for (size_t t = 0; t < kFrames; ++t) {
    Pose pose = truth.poses[t];
    pose.local[Pelvis] = z_up * pose.local[Pelvis];
    const Vec3 root = z_up * pose.root;
    trans.values.insert(trans.values.end(), root.data(), root.data() + 3);
    for (size_t j = 0; j < kJointCount; ++j) {
      const Vec3 turn = rotation_to_axis_angle(pose.local[j]);
      std::copy(turn.data(), turn.data() + 3, poses.values.begin() + static_cast<long>(156 * t + 3 * j));
    }
  }
  const TempFolder folder;
  const std::string path = folder.path("walk.npz");
  write_npz(path, {{"poses", poses}, {"trans", trans}, {"mocap_framerate", {{}, {60}, ""}}});
  ASSERT_TRUE(is_motion_file(path));
  const SkeletalMotion motion(*read_motion(path), {});
  EXPECT_DOUBLE_EQ(motion.fps(), 60);
  ASSERT_EQ(motion.count(), kFrames);
  EXPECT_LT(largest_mm(motion, truth, height_shift(motion, truth)), 1);
  EXPECT_LT(largest_deg(motion, truth), 0.1f);
}

TEST(ReadMotion, TellsMotionsFromOtherFiles) {
  const TempFolder folder;
  EXPECT_FALSE(read_motion(folder.path()));
  EXPECT_FALSE(read_motion(folder.write("scan.ply", "ply")));
  write_npz(folder.path("scan.npz"), {{"points", {{1, 2, 3}, {1, 2, 3, 4, 5, 6}, ""}}});
  EXPECT_FALSE(is_motion_file(folder.path("scan.npz")));
  write_gltf_character(folder.path("still.glb"), make_character());
  EXPECT_FALSE(read_motion(folder.path("still.glb")));
  EXPECT_TRUE(
      contains(error_of([&] { read_motion(folder.path("none.bvh")); }), "none.bvh: there is no such file"));
}

TEST(ExactSkeleton, IsNeitherSmoothedNorSolved) {
  const Truth truth;
  const SkeletalMotion motion = motion_of({}, truth);
  JointFilter filter;
  CopyTransfer transfer;
  transfer.reset(truth.rest);
  for (int64_t t = 0; t < kFrames; ++t) {
    const Extraction seen = motion.skeleton(t), kept = filter.push(seen, 1 / 120.0f);
    EXPECT_EQ(kept.joints, seen.joints);
    const Rotations local = transfer.push(kept, 1 / 120.0f);
    for (size_t j = 0; j < kJointCount; ++j)
      EXPECT_LT(geodesic_angle(local[j], truth.poses[static_cast<size_t>(t)].local[j]), 3e-3f);
  }
}

}  // namespace
}  // namespace understudy::tests
