#include "app/run/source.hpp"
#include "app/run/target_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion/bvh.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/app/program.hpp"
#include "tests/retarget/motion/made_motion.hpp"

namespace understudy::app {
namespace {

Motion standing(const Mat3& turn) {
  Motion motion;
  motion.poses.resize(2);
  for (Pose& pose : motion.poses) {
    pose.local[Pelvis] = turn;
    pose.root = turn * Vec3(0, 0.9f, 0.2f);
  }
  return motion;
}

TEST(TurnUpright, LeavesAStandingBodyAlone) {
  Motion motion = standing(rotation_about_y(1));
  EXPECT_FALSE(turn_upright(motion, "auto"));
}

TEST(TurnUpright, TurnsZUpToYUp) {
  Motion motion = standing(rotation_from_axis_angle({kPi / 2, 0, 0}));  // y to z
  EXPECT_TRUE(turn_upright(motion, "auto"));
  EXPECT_LT((motion.poses[1].root - Vec3(0, 0.9f, 0.2f)).norm(), 1e-5);
  EXPECT_LT(geodesic_angle(motion.poses[1].local[Pelvis], Mat3::Identity()), 1e-3);
}

TEST(TurnUpright, ObeysTheUser) {
  Motion motion = standing(Mat3::Identity());
  EXPECT_TRUE(turn_upright(motion, "z"));
  Motion lying = standing(rotation_from_axis_angle({kPi / 2, 0, 0}));
  EXPECT_FALSE(turn_upright(lying, "y"));
  EXPECT_THROW(turn_upright(lying, "x"), Error);
}

class SourceFiles : public testing::Test {
 protected:
  /// A round column of 200 points, 1.7 units high, written as XYZ.
  void write_frame(int number, float scale) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05d.xyz", number);
    std::ofstream file(scratch.path(name));
    for (int i = 0; i < 200; ++i)
      file << 0.2f * scale * std::cos(2.4f * i) << ' ' << scale * 0.0085f * i << ' '
           << 0.2f * scale * std::sin(2.4f * i) << '\n';
  }
  SourceOptions here() const {
    SourceOptions options;
    options.path = scratch.path("");
    return options;
  }
  tests::ScratchFolder scratch;
};

TEST_F(SourceFiles, ComeInMetresAsTheFirstFrameSays) {
  write_frame(0, 1000);
  write_frame(1, 2000);  // still millimetres: the second frame does not decide
  const auto source = open_source(here());
  EXPECT_EQ(source->count(), 2);
  EXPECT_NEAR(source->next()->mesh.vertices.col(1).maxCoeff(), 1.7f, 0.02);
  EXPECT_NEAR(source->next()->mesh.vertices.col(1).maxCoeff(), 3.4f, 0.04);
  EXPECT_FALSE(source->next());
}

/// Whose feet nobody sees: the column is its upper half.
Extraction half_seen(const Mesh& scan) {
  Extraction seen;
  seen.joints = human_rest();
  const float top = scan.vertices.col(1).maxCoeff(), low = scan.vertices.col(1).minCoeff();
  seen.joints *= (top - low) / 0.95f;
  seen.joints.col(1).array() += low;
  for (const int j : {LeftKnee, RightKnee, LeftAnkle, RightAnkle, LeftFoot, RightFoot})
    seen.visibility[j] = seen.confidence[j] = 0.1f;
  return seen;
}

TEST_F(SourceFiles, OfHalfABodyAreAsLargeAsItsBonesSay) {
  for (int t = 0; t < 3; ++t) write_frame(t, 35);  // 60 high: inches, were it all
  const auto source = open_source(here());
  int looks = 0;
  source->set_look([&](const Mesh& scan) { return ++looks, half_seen(scan); });
  const auto first = source->next(), second = source->next();
  EXPECT_EQ(looks, 1);
  EXPECT_NE(source->decision().find("centimetres"), std::string::npos) << source->decision();
  EXPECT_NEAR(first->mesh.vertices.col(1).maxCoeff() - first->mesh.vertices.col(1).minCoeff(), 0.6f, 0.01f);
  EXPECT_NEAR(first->mesh.vertices.col(1).minCoeff(), 0.7f, 0.1f);  // that is where hips are

  SourceOptions again = here();
  again.import = source->import().value();
  EXPECT_LT((open_source(again)->next()->mesh.vertices - first->mesh.vertices).cwiseAbs().maxCoeff(), 1e-5f);
}

TEST_F(SourceFiles, AreAsBeforeWhereNobodyOrAWholePersonIsSeen) {
  write_frame(0, 35);
  const auto plain = open_source(here())->next();
  const auto nobody = open_source(here()), whole = open_source(here());
  nobody->set_look([](const Mesh&) -> Extraction { throw Error("nobody"); });
  whole->set_look([](const Mesh& scan) {
    Extraction seen = half_seen(scan);
    seen.visibility.setOnes();
    return seen;
  });
  EXPECT_EQ(nobody->next()->mesh.vertices, plain->mesh.vertices);
  EXPECT_EQ(whole->next()->mesh.vertices, plain->mesh.vertices);
}

TEST_F(SourceFiles, KnowTheWayBackToTheirFiles) {
  std::ofstream file(scratch.path("frame_00000.xyz"));  // centimetres, z up, the floor at 40 cm
  for (int i = 0; i < 200; ++i)
    file << 20 * std::cos(2.4f * i) << ' ' << 20 * std::sin(2.4f * i) << ' ' << 40 + 0.85f * i << '\n';
  file.close();
  const auto source = open_source(here());
  const Vec3 first = source->next()->mesh.vertices.row(0).transpose();
  const Eigen::Vector4d back = source->to_file() * first.cast<double>().homogeneous();
  EXPECT_LT((back.head<3>() - Eigen::Vector3d(20, 0, 40)).norm(), 0.01) << back;
}

TEST_F(SourceFiles, ObeyForcedUnitsAndRate) {
  write_frame(0, 1);
  SourceOptions options = here();
  options.import.units = "cm";
  options.fps = 50;
  const auto source = open_source(options);
  EXPECT_EQ(source->fps(), 50);
  EXPECT_NEAR(source->next()->mesh.vertices.col(1).maxCoeff(), 0.017f, 0.001);
}

std::string refusal(const SourceOptions& options) {
  try {
    open_source(options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST_F(SourceFiles, AreNotAskedForBonesOrAnimations) {
  write_frame(0, 1);
  SourceOptions bones = here(), clip = here(), betas = here();
  bones.bones = {{"head", "Head"}};
  clip.clip = "walk";
  betas.betas = {1};
  EXPECT_NE(refusal(bones).find("is a scan, it has no bones"), std::string::npos) << refusal(bones);
  EXPECT_NE(refusal(clip).find("is a scan, it has no animations"), std::string::npos) << refusal(clip);
  EXPECT_NE(refusal(betas).find("--source-betas"), std::string::npos) << refusal(betas);
  EXPECT_EQ(refusal(here()), "");
}

TEST_F(SourceFiles, ACharacterThatDoesNotMoveIsAScanWithoutBones) {
  SourceOptions options;
  options.path = scratch.path("still.glb");
  write_gltf_character(options.path, tests::make_character());
  EXPECT_EQ(refusal(options), "");
  options.bones = {{"head", "mixamorig:Head"}};
  EXPECT_NE(refusal(options).find("still.glb: is a scan, it has no bones"), std::string::npos);
}

TEST_F(SourceFiles, SkeletalMotionsAreNotFollowedNorShaped) {
  SourceOptions options;
  options.path = scratch.path("walk.bvh");
  std::ofstream(options.path) << tests::made_bvh({}, tests::made_joints({}),
                                                 tests::made_motion(5, tests::made_joints({})));
  EXPECT_EQ(refusal(options), "");
  options.follow = true;
  EXPECT_NE(refusal(options).find("only a folder of scans"), std::string::npos) << refusal(options);
  options.follow = false;
  options.betas = {1};
  EXPECT_NE(refusal(options).find("--source-betas"), std::string::npos) << refusal(options);
}

TEST_F(SourceFiles, LieOnTheClockThatTheirTimesTell) {
  for (int t = 0; t < 4; ++t) write_frame(t, 1);
  tests::ScratchFolder beside;
  SourceOptions options = here();
  options.times = beside.path("times.csv");
  std::ofstream(options.times) << "file,seconds\n0,0\n1,0.04\n2,0.08\nframe_00003.xyz,0.2\n";
  std::string said;
  const log::Sink before = log::set_sink([&](log::Level, const std::string& line) { said += line + "\n"; });
  const auto source = open_source(options);
  log::set_sink(before);
  EXPECT_NE(said.find("times.csv: 4 scans in 0.24 s, 25 frames/s, 2 frames without a scan\n"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("assumed"), std::string::npos) << said;
  EXPECT_EQ(source->fps(), 25);
  EXPECT_EQ(source->count(), 6);
  std::string usable;
  while (const auto frame = source->next()) usable += frame->usable ? 'x' : '-';
  EXPECT_EQ(usable, "xxx--x");
  options.fps = 50;
  EXPECT_EQ(open_source(options)->fps(), 50);
  EXPECT_EQ(open_source(options)->count(), 11);
}

TEST_F(SourceFiles, ThatAreNoScansOrAreStillBeingWrittenHaveNoTimes) {
  write_frame(0, 1);
  SourceOptions followed = here(), skeletal, animated, body;
  followed.follow = true;
  skeletal.path = scratch.path("walk.bvh");
  const Joints rest = tests::made_joints({});
  const Character moving = parse_bvh(tests::made_bvh({}, rest, tests::made_motion(5, rest)), "walk");
  std::ofstream(skeletal.path) << tests::made_bvh({}, rest, tests::made_motion(5, rest));
  animated.path = scratch.path("walk.glb");
  write_gltf_character(animated.path, moving);
  body.path = scratch.path("body.npz"), body.motion = scratch.path("walk.npz");
  const char* const kScansAlone = "a table of times (--times) is for scans";
  for (const auto& [options, says] :
       {std::make_pair(followed, "is still being written (--follow)"), std::make_pair(skeletal, kScansAlone),
        std::make_pair(animated, kScansAlone), std::make_pair(body, kScansAlone)}) {
    SourceOptions timed = options;
    timed.times = scratch.path("times.csv");
    EXPECT_NE(refusal(timed).find(says), std::string::npos) << options.path << ": " << refusal(timed);
  }
  EXPECT_EQ(refusal(animated), "");
}

TEST_F(SourceFiles, PassABadFrameOn) {
  write_frame(0, 1);
  std::ofstream(scratch.path("frame_00001.xyz")) << "nan nan nan\n";
  write_frame(2, 1);
  const auto source = open_source(here());
  EXPECT_TRUE(source->next()->usable);
  EXPECT_FALSE(source->next()->usable);
  EXPECT_TRUE(source->next()->usable);
}

TEST_F(SourceFiles, AFrameOfThreePointsDecidesNothing) {
  std::ofstream(scratch.path("frame_00000.xyz")) << "0 0 0\n0 5000 0\n1 1 1\n";
  write_frame(1, 100);
  const auto source = open_source(here());
  EXPECT_FALSE(source->next()->usable);
  EXPECT_NEAR(source->next()->mesh.vertices.col(1).maxCoeff(), 1.7f, 0.02);
}

TEST_F(SourceFiles, AGroundAloneDecidesNothing) {
  std::ofstream ground(scratch.path("frame_00000.xyz"));
  for (int i = 0; i < 2500; ++i) ground << 8 * (i % 50) << ' ' << 8 * (i / 50) << " 0.1\n";
  ground.close();
  write_frame(1, 100);
  const auto source = open_source(here());
  const auto first = source->next();
  EXPECT_FALSE(first->usable);
  EXPECT_NE(first->problem.find("shows a ground or walls, and nobody"), std::string::npos) << first->problem;
  EXPECT_EQ(source->decision(), "");
  EXPECT_NEAR(source->next()->mesh.vertices.col(1).maxCoeff(), 1.7f, 0.02);
  EXPECT_NE(source->decision().find("centimetres"), std::string::npos) << source->decision();
  source->seek(0);
  EXPECT_TRUE(source->next()->usable);  // what was decided stays
}

TEST_F(SourceFiles, ASoughtFrameIsTheSameAsInOrder) {
  std::ofstream(scratch.path("frame_00000.xyz")) << "0 0 0\n0 5000 0\n1 1 1\n";
  std::ofstream(scratch.path("frame_00001.xyz")) << "nan nan nan\n";
  write_frame(2, 100);
  write_frame(3, 1);  // still centimetres: the frame before has decided
  const auto source = open_source(here());
  for (const int first : {1, 0, 3, 0, 2, 1}) {
    source->seek(first);
    for (int i = first; i < 4; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->number, i);
      if (i == 1) EXPECT_FALSE(frame->usable);
      if (i > 1) EXPECT_NEAR(frame->mesh.vertices.col(1).maxCoeff(), i == 2 ? 1.7f : 0.017f, 0.02);
      if (first == 0) break;
    }
  }
}

TEST_F(SourceFiles, SeekingLooksAtNothingBehindTheFrame) {
  for (int i = 0; i < 3; ++i)
    std::ofstream(scratch.path("frame_0000" + std::to_string(i) + ".xyz")) << "0 0 0\n0 1 0\n1 1 1\n";
  write_frame(3, 1);
  const auto source = open_source(here());
  source->seek(0);
  EXPECT_FALSE(source->next()->usable);
  source->seek(2);
  EXPECT_EQ(source->decision(), "");
  EXPECT_FALSE(source->next()->usable);
  EXPECT_TRUE(source->next()->usable);
}

NpyArray filled(std::vector<int64_t> shape, float value) {
  int64_t count = 1;
  for (const int64_t extent : shape) count *= extent;
  return {shape, std::vector<float>(static_cast<size_t>(count), value), {}};
}

/// A body of 44 vertices: two beside each joint, which is their mean; joints one above the other, 10 cm
/// apart.
Npz tiny_body() {
  const int vertices = 2 * kJointCount;
  Npz body{{"v_template", filled({vertices, 3}, 0)},
           {"shapedirs", filled({vertices, 3, 2}, 0)},
           {"posedirs", filled({vertices, 3, 189}, 0)},
           {"J_regressor", filled({kJointCount, vertices}, 0)},
           {"weights", filled({vertices, kJointCount}, 0)},
           {"kintree_table", filled({2, kJointCount}, 0)},
           {"f", filled({vertices - 2, 3}, 0)}};
  for (int v = 0; v < vertices; ++v) {
    const int joint = v / 2;
    body["v_template"].values[v * 3] = v % 2 ? 0.05f : -0.05f;
    body["v_template"].values[v * 3 + 1] = 0.08f * joint;
    body["J_regressor"].values[joint * vertices + v] = 0.5f;
    body["weights"].values[v * kJointCount + joint] = 1;
    body["shapedirs"].values[(v * 3 + 1) * 2] = 0.04f * joint;  // the first parameter makes it taller
  }
  for (int f = 0; f < vertices - 2; ++f)
    for (int corner = 0; corner < 3; ++corner)
      body["f"].values[f * 3 + corner] = static_cast<float>(f + corner);
  for (int j = 1; j < kJointCount; ++j) body["kintree_table"].values[j] = static_cast<float>(kParents[j]);
  body["kintree_table"].values[0] = -1;
  return body;
}

TEST_F(SourceFiles, ABodyPerformsAMotion) {
  write_npz(scratch.path("body.npz"), tiny_body());
  Npz motion{
      {"poses", filled({3, 66}, 0)}, {"trans", filled({3, 3}, 0)}, {"mocap_framerate", filled({}, 60)}};
  motion["trans"].values = {0, 1, 0, 0.5f, 1, 0, 1, 1, 0};
  write_npz(scratch.path("motion.npz"), motion);
  SourceOptions options;
  options.path = scratch.path("body.npz");
  options.motion = scratch.path("motion.npz");
  const auto source = open_source(options);
  EXPECT_EQ(source->fps(), 60);
  EXPECT_EQ(source->count(), 3);
  const Points first = source->next()->mesh.vertices, second = source->next()->mesh.vertices;
  EXPECT_NEAR((second.col(0) - first.col(0)).mean(), 0.5f, 1e-5);
  EXPECT_NEAR(first.col(1).minCoeff(), 0, 0.1);  // on the floor
  options.truth = true;
  options.import.turn_deg = 90;
  const auto turned = open_source(options);
  const auto frame = turned->next();
  ASSERT_TRUE(frame->truth);
  for (int j = 0; j < kJointCount; ++j)  // in the middle of its two vertices
    EXPECT_LT(
        (frame->truth->joints.row(j) - frame->mesh.vertices.middleRows(2 * j, 2).colwise().mean()).norm(),
        1e-4f);
  EXPECT_NEAR(heading_of((*frame->truth->global)[Head]), kPi / 2, 1e-4f);
}

TEST_F(SourceFiles, ASkeletonThatMovesIsASource) {
  const Joints rest = tests::made_joints({});
  const std::string path = scratch.path("walk.bvh");
  std::ofstream(path) << tests::made_bvh({}, rest, tests::made_motion(10, rest));
  SourceOptions options;
  options.path = path;
  const auto source = open_source(options);
  EXPECT_EQ(source->count(), 10);
  EXPECT_EQ(source->fps(), 120);
  EXPECT_NE(source->decision().find("22 of 22 joints"), std::string::npos) << source->decision();
  source->seek(7);
  const auto frame = source->next();
  ASSERT_TRUE(frame && frame->skeleton);
  EXPECT_EQ(frame->number, 7);
  EXPECT_GT(frame->mesh.faces.rows(), 0);  // its bones, to look at
  EXPECT_TRUE(frame->skeleton->exact);
  while (source->next()) {
  }
  EXPECT_THROW(source->seek(10), Error);
  options.as_scan = true;
  EXPECT_THROW(open_source(options), Error);  // bones have no surface
}

TEST_F(SourceFiles, AnAnimatedSurfaceIsSampledAnewWhereAScanIsAskedFor) {
  Character person = tests::make_character();
  CharacterTrack path;
  path.node = 1;  // the hips
  path.path = TrackPath::Translation;
  path.times = {0, 0.5f, 1};
  const Vec3 at = person.nodes[1].local.translation;
  for (const float x : {0.0f, 0.5f, 1.0f})
    path.values.insert(path.values.end(), {at.x() + x, at.y(), at.z()});
  person.animations.push_back({"slide", {path}});
  SourceOptions options;
  options.path = scratch.path("slide.glb");
  write_gltf_character(options.path, person);
  options.as_scan = true;
  options.fps = 4;
  const auto source = open_source(options);
  EXPECT_EQ(source->count(), 5);
  const auto first = source->next(), second = source->next();
  EXPECT_FALSE(first->skeleton);
  EXPECT_TRUE(first->mesh.is_cloud());
  EXPECT_EQ(first->mesh.vertices.rows(), 8000);
  EXPECT_NEAR((second->mesh.vertices.col(0).mean() - first->mesh.vertices.col(0).mean()), 0.25f, 0.02f);
  EXPECT_GT((second->mesh.vertices.row(0) - first->mesh.vertices.row(0)).norm(), 0.01f);
  EXPECT_FALSE(first->truth);  // nobody asked
  options.as_scan = false;
  EXPECT_TRUE(open_source(options)->next()->skeleton);
}

TEST_F(SourceFiles, AnAnimatedSurfaceBringsItsBonesToBeJudgedByWhereTheyAreAskedFor) {
  SourceOptions options;
  options.path = scratch.path("turn.glb");
  Character person = tests::make_character();
  CharacterTrack turn;
  turn.node = 1;  // the hips
  turn.path = TrackPath::Rotation;
  turn.times = {0, 1};
  turn.values = {0, 0, 0, 1, 0, std::sqrt(0.5f), 0, std::sqrt(0.5f)};  // a quarter about y
  person.animations.push_back({"turn", {turn}});
  write_gltf_character(options.path, person);
  options.as_scan = options.truth = true;
  options.fps = 1;
  options.import.turn_deg = 30;
  const auto source = open_source(options);
  const auto first = source->next(), last = source->next();
  ASSERT_TRUE(first->truth && last->truth);
  for (const auto& frame : {first, last}) {
    const Points& scan = frame->mesh.vertices;
    const Eigen::RowVector3f middle = frame->truth->joints.row(Pelvis), low = scan.colwise().minCoeff(),
                             high = scan.colwise().maxCoeff();
    EXPECT_TRUE((middle.array() > low.array()).all() && (middle.array() < high.array()).all());
    EXPECT_LT(frame->truth->joints(LeftAnkle, 1), 0.25f);  // on the scan's floor, at its size
    EXPECT_GT(frame->truth->joints(Head, 1), 0.8f * high.y());
  }
  const Mat3 before = (*first->truth->global)[Pelvis], after = (*last->truth->global)[Pelvis];
  EXPECT_NEAR(heading_of(after * before.transpose()), kPi / 2, 0.01f);
}

TEST_F(SourceFiles, ABodyIsOneWhateverTheCaseOfItsSuffix) {
  write_npz(scratch.path("BODY.NPZ"), tiny_body());
  EXPECT_GT(read_target(scratch.path("BODY.NPZ"), {1}).vertex_count(), 0);
}

TEST_F(SourceFiles, ATargetTakesShapeParameters) {
  write_npz(scratch.path("body.npz"), tiny_body());
  const Character plain = read_target(scratch.path("body.npz"), {}),
                  tall = read_target(scratch.path("body.npz"), {1});
  EXPECT_NEAR(plain.parts.at(0).vertices.col(1).maxCoeff(), 0.08f * 21, 1e-5);
  EXPECT_NEAR(tall.parts.at(0).vertices.col(1).maxCoeff(), 0.12f * 21, 1e-5);
  write_frame(0, 1);
  EXPECT_THROW(read_target(scratch.path("frame_00000.xyz"), {1}), Error);
}

}  // namespace
}  // namespace understudy::app
