#include "retarget/editing/scan_edits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/geometry/ground_finder.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

/// The built-in person walking, soles near y = 0, as a mesh; frame of 30 a second.
Mesh walker(int frame) {
  static const ShapedBody body = builtin_person();
  static const Motion motion = builtin_motion("walk", body.joints);
  const auto posed = forward_kinematics(body.joints, motion.poses[static_cast<size_t>(frame)]);
  Mesh mesh;
  mesh.vertices = linear_blend_skinning(body.vertices, body.weights, body.joints, posed);
  mesh.faces = body.faces;
  return mesh;
}

/// Numbers of the vertices of a cloud that the edits leave.
std::vector<int> kept_vertices(const ScanEdits& edits, Mesh cloud) {
  cloud.colors = Points::Zero(cloud.vertices.rows(), 3);  // they go with their vertices
  for (Eigen::Index i = 0; i < cloud.colors.rows(); ++i) cloud.colors(i, 0) = static_cast<float>(i);
  std::vector<int> kept;
  const Mesh left = apply(edits, cloud);
  for (const float number : left.colors.col(0)) kept.push_back(static_cast<int>(number));
  return kept;
}

/// A scan of the person: `count` points, then floor points over a disc of 0.7 m, then a few strays.
struct Scan {
  Mesh cloud;
  int body = 0, floor = 0;
  Scan(int frame, int body_points, int floor_points, float tilt_deg = 0, float height = 0) {
    Rng rng(7);
    const Mesh mesh = walker(frame);
    const Points on_body = sample_points(mesh, body_points, rng);
    const Vec3 middle = on_body.colwise().mean().transpose();
    cloud.vertices.resize(body_points + floor_points, 3);
    cloud.vertices.topRows(body_points) = on_body;
    for (int i = 0; i < floor_points; ++i) {
      const float r = 0.7f * std::sqrt(rng.uniform()), a = rng.uniform(0, 2 * kPi);
      cloud.vertices.row(body_points + i) << middle.x() + r * std::cos(a), 0.004f * rng.normal(),
          middle.z() + r * std::sin(a);
    }
    const Mat3 R = rotation_from_axis_angle(Vec3(tilt_deg * kPi / 180, 0, 0));
    cloud.vertices = (cloud.vertices * R.transpose()).rowwise() + Eigen::RowVector3f(0, height, 0);
    body = body_points;
    floor = floor_points;
  }
  /// Shares of the body's and of the floor's points that stay.
  std::pair<float, float> kept(const ScanEdits& edits) const {
    int b = 0, f = 0;
    for (const int i : kept_vertices(edits, cloud)) (i < body ? b : f)++;
    return {static_cast<float>(b) / static_cast<float>(body),
            static_cast<float>(f) / static_cast<float>(floor)};
  }
  /// Of the body's points below 2 cm (the soles).
  float soles_kept(const ScanEdits& edits) const {
    int all = 0, stay = 0;
    std::vector<char> kept(static_cast<size_t>(cloud.vertices.rows()), 0);
    for (const int i : kept_vertices(edits, cloud)) kept[static_cast<size_t>(i)] = 1;
    for (int i = 0; i < body; ++i)
      if (cloud.vertices(i, 1) < 0.02f) ++all, stay += kept[static_cast<size_t>(i)];
    return static_cast<float>(stay) / static_cast<float>(all);
  }
};

TEST(CropBox, KeepsWhatIsInside) {
  Mesh cloud;
  cloud.vertices.resize(4, 3);
  cloud.vertices << 0, 0, 0, 2, 0, 0, 0.5f, 0.5f, 0.5f, NAN, 0, 0;
  cloud.colors = Points::Random(4, 3);
  ScanEdits edits;
  edits.crop = Box{Vec3(-1, -1, -1), Vec3(1, 1, 1)};
  const Mesh left = apply(edits, cloud);
  ASSERT_EQ(left.vertices.rows(), 2);
  EXPECT_EQ(left.vertices.row(1), cloud.vertices.row(2));
  EXPECT_EQ(left.colors.row(1), cloud.colors.row(2));
  edits.crop = Box{Vec3(1, 1, 1), Vec3(-1, -1, -1)};
  EXPECT_THROW(apply(edits, cloud), Error);
}

TEST(CropBox, OfAMeshKeepsFacesWhoseCornersAllStay) {
  const Mesh mesh = walker(0);
  ScanEdits edits;
  edits.crop = Box{Vec3(-3, 1, -3), Vec3(3, 3, 3)};
  const Mesh left = apply(edits, mesh);
  int expected = 0;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    bool all = true;
    for (int k = 0; k < 3; ++k) all = all && mesh.vertices(mesh.faces(f, k), 1) >= 1;
    expected += all;
  }
  EXPECT_GT(expected, 100);
  EXPECT_EQ(left.faces.rows(), expected);
  EXPECT_LT(left.faces.maxCoeff(), left.vertices.rows());
  EXPECT_GE(left.vertices.col(1).minCoeff(), 1);
}

TEST(ScanEdits, NoneLeaveTheScan) {
  const Mesh mesh = walker(3);
  EXPECT_EQ(apply(ScanEdits{}, mesh).vertices, mesh.vertices);
  EXPECT_EQ(apply(ScanEdits{}, mesh).faces, mesh.faces);
}

TEST(ScanEdits, OfAnEmptyScanGiveAnEmptyScan) {
  ScanEdits edits;
  edits.crop = Box{};
  edits.floor = FloorCut{};
  edits.largest_cluster = true;
  Mesh empty;
  empty.vertices.resize(0, 3);
  EXPECT_EQ(apply(edits, empty).vertices.rows(), 0);
}

TEST(FloorCut, TakesTheFloorAndLeavesTheFeet) {
  ScanEdits edits;
  edits.floor = FloorCut{};
  for (const int frame : {0, 20, 50}) {
    const Scan scan(frame, 8000, 4000);
    const auto [body, floor] = scan.kept(edits);
    EXPECT_GT(body, 0.99f) << frame;
    EXPECT_GT(scan.soles_kept(edits), 0.85f) << frame;
    EXPECT_LT(floor, 0.09f) << frame;  // what lies under the soles cannot be told from them: 5 in 100
  }
}

TEST(FloorCut, FollowsATiltedFloorThatWasFound) {
  const Scan scan(20, 8000, 4000, -6, 0.4f);
  ScanEdits level, found;
  level.floor = FloorCut{};
  level.floor->height_m = 0.4f;
  const auto ground = GroundFinder().push(Cells(scan.cloud, 0.05f));
  ASSERT_TRUE(ground);
  EXPECT_NEAR(std::acos(ground->plane.normal.y()) * 180 / kPi, 6, 0.7f);
  found.floor = FloorCut{};
  found.floor->plane = ground->plane;
  EXPECT_GT(scan.kept(level).second, 0.2f);
  EXPECT_LT(scan.kept(found).second, 0.10f);
  EXPECT_GT(scan.kept(found).first, 0.98f);
}

TEST(LargestCluster, SendsAwayASecondPersonAndStrays) {
  Rng rng(3);
  const Points first = sample_points(walker(0), 6000, rng);
  Points second = sample_points(walker(30), 4000, rng);
  second.rowwise() += Eigen::RowVector3f(1.5f, 0, 0);
  Mesh cloud;
  cloud.vertices.resize(10001, 3);
  cloud.vertices << second, first, Eigen::RowVector3f(0, 3, 0);
  ScanEdits edits;
  edits.largest_cluster = true;
  const auto kept = kept_vertices(edits, cloud);
  ASSERT_EQ(kept.size(), 6000u);
  EXPECT_EQ(kept.front(), 4000);
  EXPECT_EQ(kept.back(), 9999);
}

TEST(LargestCluster, JoinsExactlyWhatIsCloserThanTheGap) {
  // A row of points 4 cm apart with one gap of 9 cm; and every pair distance just over and under the limit.
  Rng rng(5);
  for (int round = 0; round < 50; ++round) {
    Vec3 way(rng.normal(), rng.normal(), rng.normal());
    way.normalize();
    Mesh cloud;
    cloud.vertices.resize(12, 3);
    const Vec3 start(rng.uniform(), rng.uniform(), rng.uniform());
    for (int i = 0; i < 12; ++i)
      cloud.vertices.row(i) =
          (start + way * (0.04f * static_cast<float>(i) + (i >= 7 ? 0.05f : 0.0f))).transpose();
    ScanEdits edits;
    edits.largest_cluster = true;
    edits.cluster_gap_m = 0.0905f;
    EXPECT_EQ(kept_vertices(edits, cloud).size(), 12u);
    edits.cluster_gap_m = 0.0895f;
    EXPECT_EQ(kept_vertices(edits, cloud).size(), 7u);
  }
}

TEST(LargestCluster, OfAMeshHoldsTogetherWhatFacesJoin) {
  Mesh mesh;  // two triangles with edges of a metre; a third vertex apart from both
  mesh.vertices.resize(7, 3);
  mesh.vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0;
  mesh.faces.resize(3, 3);
  mesh.faces << 0, 1, 2, 1, 3, 2, 4, 5, 6;
  ScanEdits edits;
  edits.largest_cluster = true;
  const Mesh left = apply(edits, mesh);
  EXPECT_EQ(left.vertices.rows(), 4);
  EXPECT_EQ(left.faces.rows(), 2);
}

}  // namespace
}  // namespace understudy
