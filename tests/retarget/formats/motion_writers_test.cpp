// Motions and surfaces over time, read back.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "retarget/body/body.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/surface_writer.hpp"
#include "retarget/motion/bvh.hpp"
#include "tests/retarget/formats/support.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;
using fixtures::dance;
using test::contains;
using test::error_of;
using test::TempFolder;

constexpr double kFps = 24;

Pose pose_at(int frame) {
  return dance(static_cast<float>(frame) / static_cast<float>(kFps));
}

int files_in(const TempFolder& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

std::string written_bvh(const TempFolder& folder, const std::vector<Pose>& poses) {
  BvhWriter writer(folder.path("a.bvh"), human_rest(), kFps);
  for (const Pose& pose : poses) writer.push(pose);
  writer.finish();
  return folder.path("a.bvh");
}

TEST(BvhWriter, PlaysTheSameMotionWhenReadBack) {
  const TempFolder folder;
  std::vector<Pose> poses;
  for (int t = 0; t < 40; ++t) poses.push_back(pose_at(t));
  const Character read = read_bvh(written_bvh(folder, poses));
  EXPECT_EQ(files_in(folder), 1);
  for (const int t : {0, 7, 39}) {
    const Joints want = forward_kinematics(human_rest(), poses[static_cast<size_t>(t)]).joints;
    const PosedNodes nodes = nodes_at(read, 0, static_cast<float>(t / kFps));
    for (int j = 0; j < kJointCount; ++j)
      for (size_t n = 0; n < read.nodes.size(); ++n)
        if (read.nodes[n].name == kJointNames[static_cast<size_t>(j)])
          EXPECT_LT((nodes.world[n].topRightCorner<3, 1>() / 100 - want.row(j).transpose()).norm(), 1e-4f)
              << t << ' ' << kJointNames[static_cast<size_t>(j)];
  }
}

TEST(BvhWriter, AnglesDoNotJumpInASpin) {
  const TempFolder folder;
  std::vector<Pose> poses;
  for (int t = 0; t < 100; ++t) {
    Pose pose = dance(0);
    pose.local[Pelvis] =
        rotation_about_y(0.15f * static_cast<float>(t)) *
        rotation_from_axis_angle(Vec3(1.2f * std::sin(0.1f * static_cast<float>(t)), 0, 0.4f));
    poses.push_back(pose);
  }
  std::istringstream text(read_file(written_bvh(folder, poses)));
  std::string line;
  while (std::getline(text, line) && line.rfind("Frame Time", 0) != 0) continue;
  std::vector<double> before;
  while (std::getline(text, line)) {
    std::istringstream numbers(line);
    std::vector<double> now;
    for (double value; numbers >> value;) now.push_back(value);
    ASSERT_EQ(now.size(), 3u + 3 * kJointCount);
    for (size_t i = 3; i < now.size() && !before.empty(); ++i)
      EXPECT_LT(std::abs(now[i] - before[i]), 60) << i;
    before = now;
  }
}

TEST(BvhWriter, TurnsThatPointStraightUpStayThemselves) {
  const TempFolder folder;
  Pose pose = dance(1);
  pose.local[LeftShoulder] =
      rotation_from_axis_angle(Vec3(kPi / 2, 0, 0)) * rotation_from_axis_angle(Vec3(0, 0.7f, 0));
  const Character read = read_bvh(written_bvh(folder, {pose, pose}));
  const Joints want = forward_kinematics(human_rest(), pose).joints;
  const PosedNodes nodes = nodes_at(read, 0, 0);
  for (size_t n = 0; n < read.nodes.size(); ++n)
    if (read.nodes[n].name == "left_wrist")
      EXPECT_LT((nodes.world[n].topRightCorner<3, 1>() / 100 - want.row(LeftWrist).transpose()).norm(),
                1e-4f);
}

TEST(AmassWriter, IsReadBackAsTheMotionItWasWithZUp) {
  const TempFolder folder;
  AmassWriter writer(folder.path("a.npz"), kFps);
  for (int t = 0; t < 10; ++t) writer.push(pose_at(t));
  writer.finish();
  const Npz npz = read_npz(folder.path("a.npz"));
  EXPECT_EQ(npz.at("poses").shape, (std::vector<int64_t>{10, 156}));
  EXPECT_EQ(npz.at("betas").shape, (std::vector<int64_t>{16}));
  EXPECT_EQ(npz.at("gender").text, "neutral");
  const Motion motion = read_amass_motion(folder.path("a.npz"));
  EXPECT_FLOAT_EQ(motion.fps, static_cast<float>(kFps));
  const Pose want = pose_at(7), &got = motion.poses[7];
  EXPECT_NEAR(got.root.x(), want.root.x(), 1e-5f);
  EXPECT_NEAR(got.root.z(), want.root.y(), 1e-5f);  // up
  EXPECT_NEAR(got.root.y(), -want.root.z(), 1e-5f);
  EXPECT_NEAR((got.local[Pelvis] * Vec3::UnitY()).z(), (want.local[Pelvis] * Vec3::UnitY()).y(), 1e-4f);
  for (size_t j = 1; j < kJointCount; ++j) EXPECT_LT(geodesic_angle(got.local[j], want.local[j]), 1e-3f);
  EXPECT_EQ(files_in(folder), 1);
}

TEST(ResultWriter, WritesWhatWasPushed) {
  const TempFolder folder;
  const Points vertices = fixtures::PointBody(human_rest()).mesh.vertices;
  {
    ResultWriter writer(folder.path("r.npz"), vertices.rows());
    for (int i = 0; i < 5; ++i) {
      const Pose pose = dance(static_cast<float>(i));
      writer.push(vertices * static_cast<float>(i), forward_kinematics(human_rest(), pose).joints, pose.local,
                  human_rest());
    }
    Eigen::Matrix4d to_scan = Eigen::Matrix4d::Identity();
    to_scan(0, 3) = 7;
    writer.finish(to_scan);
  }
  const Npz npz = read_npz(folder.path("r.npz"));
  const NpyArray& to_scan = require(npz, "source_to_scan", "r.npz");
  EXPECT_EQ(to_scan.shape, (std::vector<int64_t>{4, 4}));
  EXPECT_EQ(to_scan.values[3], 7);
  const NpyArray& v = require(npz, "vertices", "r.npz");
  EXPECT_EQ(v.shape, (std::vector<int64_t>{5, vertices.rows(), 3}));
  EXPECT_FLOAT_EQ(v.values.back(), 4 * vertices(vertices.rows() - 1, 2));
  const NpyArray& R = require(npz, "rotations", "r.npz");
  EXPECT_EQ(R.shape, (std::vector<int64_t>{5, 22, 3, 3}));
  EXPECT_FLOAT_EQ(R.values[22 * 9 + 1], dance(1).local[0](0, 1));
  EXPECT_EQ(files_in(folder), 1);
}

TEST(ResultWriter, LeavesNothingBehindWhenNotFinished) {
  const TempFolder folder;
  { ResultWriter writer(folder.path("r.npz"), 10); }
  EXPECT_EQ(files_in(folder), 0);
}

TEST(ResultWriter, RefusesAFrameOfAnotherSize) {
  const TempFolder folder;
  ResultWriter writer(folder.path("r.npz"), 10);
  EXPECT_THROW(writer.push(Points::Zero(9, 3), human_rest(), identity_rotations(), human_rest()), Error);
}

TEST(JointTable, HasALineAFrameAndAColumnACoordinate) {
  const TempFolder folder;
  JointTable table(folder.path("a.csv"), kFps);
  const Joints joints = forward_kinematics(human_rest(), pose_at(1)).joints;
  table.push(human_rest());
  table.push(joints);
  table.finish();
  std::istringstream text(read_file(folder.path("a.csv")));
  std::string header, line;
  std::getline(text, header);
  EXPECT_EQ(header.rfind("frame,seconds,pelvis_x,pelvis_y,pelvis_z,left_hip_x", 0), 0u);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), 1 + 3 * kJointCount);
  std::getline(text, line);
  std::getline(text, line);
  for (char& c : line) c = c == ',' ? ' ' : c;
  std::istringstream numbers(line);
  double frame = 0, seconds = 0, x = 0, y = 0;
  numbers >> frame >> seconds >> x >> y;
  EXPECT_EQ(frame, 1);
  EXPECT_NEAR(seconds, 1 / kFps, 1e-6);
  EXPECT_NEAR(y, joints(0, 1), 1e-6);
}

/// A pyramid with colours and a seam in its texture.
SurfaceTopology pyramid(Points& vertices) {
  SurfaceTopology t;
  t.vertex_count = 4;
  vertices.resize(4, 3);
  vertices << 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1f, 1.25f, 0.3f;
  t.faces.resize(4, 3);
  t.faces << 0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0;
  t.colors = Points::Constant(4, 3, 0.2f);
  t.colors(3, 0) = 1;
  return t;
}

TEST(SequenceWriter, FramesReadBackAsTheyWere) {
  for (const SequenceFormat format : {SequenceFormat::Ply, SequenceFormat::Obj}) {
    const TempFolder folder;
    Points vertices;
    SurfaceTopology t = pyramid(vertices);
    t.uvs = RowMatrix::Random(6, 2);
    t.uv_faces = t.faces;
    t.uv_faces(3, 0) = 5;
    SequenceWriter writer(folder.path("out"), format, t);
    for (int i = 0; i < 3; ++i) writer.push(vertices * static_cast<float>(i + 1));
    EXPECT_FALSE(fs::exists(folder.path("out")));
    writer.finish();
    EXPECT_EQ(files_in(folder), 1);
    const std::string name = format == SequenceFormat::Ply ? "out/frame_00002.ply" : "out/frame_00002.obj";
    const Mesh mesh = read_mesh(folder.path(name));
    EXPECT_EQ(mesh.vertices, Points(vertices * 2));
    EXPECT_EQ(mesh.faces, t.faces);
    EXPECT_NEAR(mesh.colors(3, 0), 1, 0.01f);
    EXPECT_NEAR(mesh.colors(0, 1), 0.2f, 0.01f);
    if (format == SequenceFormat::Obj) EXPECT_TRUE(contains(read_file(folder.path(name)), "f 3/6 4/4 1/1"));
  }
}

TEST(SequenceWriter, APlyHasTextureCoordinatesWhereEachVertexHasOne) {
  Points vertices;
  SurfaceTopology t = pyramid(vertices);
  t.uvs = RowMatrix::Random(4, 2);
  t.uv_faces = t.faces;
  EXPECT_TRUE(contains(ply_bytes(t, vertices, ""), "property float s"));
  const TempFolder folder;
  EXPECT_EQ(read_mesh(folder.write("a.ply", ply_bytes(t, vertices, "x"))).vertices, vertices);
}

TEST(SequenceWriter, APlyOfPointsAloneHoldsNothingElse) {
  const Points points = Points::Random(5, 3);
  const std::string bytes = ply_bytes({}, points, "");
  EXPECT_FALSE(contains(bytes, "comment") || contains(bytes, "property float s"));
  const TempFolder folder;
  EXPECT_EQ(read_mesh(folder.write("a.ply", bytes)).vertices, points);
}

TEST(SequenceWriter, ReplacesOnlyWhatItWrote) {
  const TempFolder folder;
  Points vertices;
  const SurfaceTopology t = pyramid(vertices);
  const auto write = [&](int frames) {
    SequenceWriter writer(folder.path("out/"), SequenceFormat::Ply, t);
    for (int i = 0; i < frames; ++i) writer.push(vertices);
    writer.finish();
  };
  fs::create_directories(folder.path("out"));  // empty: nothing is lost
  write(3);
  write(1);
  EXPECT_FALSE(fs::exists(folder.path("out/frame_00002.ply")));
  folder.write("out/mine.txt", "hours of work");
  EXPECT_TRUE(contains(error_of([&] { write(1); }), "more than exported frames"));
  EXPECT_EQ(read_file(folder.path("out/mine.txt")), "hours of work");
  fs::remove(folder.path("out/mine.txt"));
  folder.write("out/frame_00002.ply", "ply\nformat ascii 1.0\ncomment a scan of mine\n");
  EXPECT_TRUE(contains(error_of([&] { write(1); }), "more than exported frames"));
  EXPECT_EQ(files_in(folder), 1);
}

TEST(PointCacheWriter, HoldsEveryVertexOfEveryFrame) {
  const TempFolder folder;
  Points vertices;
  const SurfaceTopology t = pyramid(vertices);
  PointCacheWriter writer(folder.path("a.pc2"), t, vertices);
  for (int i = 0; i < 5; ++i) writer.push(vertices * static_cast<float>(i));
  writer.finish();
  const std::string bytes = read_file(folder.path("a.pc2"));
  ASSERT_EQ(bytes.size(), 32u + 5 * 4 * 3 * 4);
  EXPECT_EQ(bytes.compare(0, 12, std::string("POINTCACHE2\0", 12)), 0);
  EXPECT_EQ(load<int32_t>(&bytes[12], false), 1);
  EXPECT_EQ(load<int32_t>(&bytes[16], false), 4);
  EXPECT_EQ(load<int32_t>(&bytes[28], false), 5);
  EXPECT_EQ(load<float>(&bytes[32 + (3 * 12 + 10) * 4], false), 3 * vertices(3, 1));
  EXPECT_EQ(read_mesh(folder.path("a.pc2.obj")).vertices, vertices);
  EXPECT_EQ(files_in(folder), 2);
}

TEST(MotionWriters, LeaveNothingBehindWhenGivenUp) {
  const TempFolder folder;
  Points vertices;
  const SurfaceTopology t = pyramid(vertices);
  {
    BvhWriter bvh(folder.path("a.bvh"), human_rest(), kFps);
    AmassWriter amass(folder.path("a.npz"), kFps);
    JointTable table(folder.path("a.csv"), kFps);
    SequenceWriter sequence(folder.path("a"), SequenceFormat::Obj, t);
    PointCacheWriter cache(folder.path("a.pc2"), t, vertices);
    bvh.push(pose_at(0));
    amass.push(pose_at(0));
    table.push(human_rest());
    sequence.push(vertices);
    cache.push(vertices);
  }
  EXPECT_EQ(files_in(folder), 0);
}

TEST(MotionWriters, RefuseWhatIsNotFiniteOrOfAnotherSize) {
  const TempFolder folder;
  Points vertices;
  const SurfaceTopology t = pyramid(vertices);
  Pose broken;
  broken.local[Head](1, 1) = NAN;
  const auto refused = [&](auto&& writer, const auto& value) {
    return !error_of([&] { writer.push(value); }).empty();
  };
  EXPECT_TRUE(refused(BvhWriter(folder.path("a.bvh"), human_rest(), kFps), broken));
  EXPECT_TRUE(refused(AmassWriter(folder.path("a.npz"), kFps), broken));
  EXPECT_TRUE(refused(JointTable(folder.path("a.csv"), kFps), Joints(Joints::Constant(NAN))));
  EXPECT_TRUE(refused(SequenceWriter(folder.path("a"), SequenceFormat::Ply, t), Points(Points::Zero(3, 3))));
  EXPECT_TRUE(refused(PointCacheWriter(folder.path("a.pc2"), t, vertices), Points(Points::Zero(5, 3))));
  EXPECT_FALSE(error_of([&] { BvhWriter(folder.path("no/a.bvh"), human_rest(), kFps); }).empty());
  EXPECT_FALSE(error_of([&] { BvhWriter(folder.path("a.bvh"), human_rest(), 0); }).empty());
}

}  // namespace
}  // namespace understudy
