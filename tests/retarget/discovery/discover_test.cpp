#include "retarget/discovery/discover.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/discovery/rig_follower.hpp"
#include "retarget/discovery/thinned_frames.hpp"
#include "retarget/geometry/point_tree.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"

namespace understudy {
namespace {

TEST(Discover, FindsTheElbowOfAnArm) {
  const DiscoveredRig& rig = found_arm();
  ASSERT_EQ(rig.found.rig.count(), 2);
  ASSERT_EQ(rig.found.motion.poses.size(), static_cast<size_t>(kFrames));
  const RigJoint& elbow = rig.found.rig.joints[1];
  EXPECT_EQ(elbow.kind, JointKind::Hinge);
  EXPECT_GT(std::abs(elbow.axis.z()), 0.99f);
  EXPECT_LT((elbow.rest - kElbow).norm(), 0.03f);
  const float first = rotation_to_axis_angle(rig.found.motion.poses.front().turns[1]).z(),
              last = rotation_to_axis_angle(rig.found.motion.poses.back().turns[1]).z();
  EXPECT_NEAR(std::abs(last - first), angle_at(kFrames - 1), 0.08f);
  EXPECT_TRUE(rig.complete);
  EXPECT_LT(rig.off_m[5], 0.02f);
}

TEST(Discover, GivesTheSameBytesForTheSameScans) {
  const DiscoveredRig &a = found_arm(), b = discover(bending_arm());
  ASSERT_EQ(a.found.rig.count(), b.found.rig.count());
  EXPECT_TRUE(a.found.rig.skin.weights == b.found.rig.skin.weights);
  for (size_t t = 0; t < a.found.motion.poses.size(); ++t) {
    EXPECT_TRUE(a.found.motion.poses[t].root == b.found.motion.poses[t].root) << t;
    EXPECT_TRUE(a.found.motion.poses[t].turns[1] == b.found.motion.poses[t].turns[1]) << t;
  }
}

TEST(Discover, OfCloudsTheSurfaceIsClosedAndLiesOnThem) {
  const Rig& rig = found_arm().found.rig;
  EXPECT_TRUE(is_closed(rig.surface.faces));
  EXPECT_GT(rig.surface.faces.rows(), 6000);
  const Points cloud = bent_arm(angle_at(found_arm().rest_frame), 77).vertices;
  const PointTree tree(cloud);
  double sum = 0;
  for (const auto& v : rig.surface.vertices.rowwise())
    sum += std::sqrt(static_cast<double>(tree.nearest(v.transpose()).squared));
  EXPECT_LT(sum / static_cast<double>(rig.surface.vertices.rows()), 0.012);
}

TEST(Discover, ColoursOfCloudsGoOverToTheSurface) {
  const DiscoveredRig rig = discover(sequence(6, [](int t) {
    Mesh scan = bent_arm(angle_at(t), static_cast<uint64_t>(t));
    scan.colors = Points::Zero(scan.vertices.rows(), 3);
    scan.colors.topRows(2000).col(0).setOnes();  // the upper arm is red
    return scan;
  }));
  const Mesh& surface = rig.found.rig.surface;
  ASSERT_EQ(surface.colors.rows(), surface.vertices.rows());
  for (Eigen::Index v = 0; v < surface.vertices.rows(); ++v)
    if (surface.vertices(v, 0) < 0.4f) EXPECT_EQ(surface.colors(v, 0), 1) << surface.vertices.row(v);
}

TEST(Discover, WhatOnlyTravelsIsOneBone) {
  const DiscoveredRig rig = discover(sequence(8, [](int t) {
    return sparse_arm(0.3f, t, {0.03f * static_cast<float>(t), 0, 0});
  }));
  EXPECT_EQ(rig.found.rig.count(), 1);
  EXPECT_NEAR(rig.found.motion.poses[7].root.x() - rig.found.motion.poses[0].root.x(), 0.21f, 0.02f);
}

TEST(Discover, WhatStandsStillIsOneBone) {
  const DiscoveredRig rig =
      discover(sequence(6, [](int t) { return bent_arm(0.3f, static_cast<uint64_t>(t)); }));
  EXPECT_EQ(rig.found.rig.count(), 1);
}

TEST(Discover, KeepsToTheBonesThatAreAllowed) {
  DiscoveryOptions options;
  options.parts = 1;
  EXPECT_EQ(discover(bending_arm(), options).found.rig.count(), 1);
}

TEST(Discover, AFrameWithoutPointsRepeatsThePoseBefore) {
  const DiscoveredRig rig =
      discover(sequence(kFrames, [](int t) { return t == 7 ? Mesh{} : sparse_arm(angle_at(t), t); }));
  ASSERT_EQ(rig.found.motion.poses.size(), static_cast<size_t>(kFrames));
  EXPECT_TRUE(rig.doubted[7]);
  EXPECT_FALSE(rig.doubted[6]);
  EXPECT_TRUE(rig.found.motion.poses[7].turns[1] == rig.found.motion.poses[6].turns[1]);
}

TEST(Discover, FollowsWhatComesAfterItsKeyFrames) {
  constexpr int kMany = 66;  // bends and stretches slowly
  const auto at = [](int t) { return 0.6f - 0.6f * std::cos(0.15f * static_cast<float>(t)); };
  const DiscoveredRig rig =
      discover(sequence(kMany, [&](int t) { return bent_arm(at(t), static_cast<uint64_t>(t)); }));
  EXPECT_LT(rig.key_frames.size(), static_cast<size_t>(kMany));
  ASSERT_EQ(rig.found.rig.count(), 2);
  const auto turn = [&](int t) {
    return rotation_to_axis_angle(rig.found.motion.poses[static_cast<size_t>(t)].turns[1]).z();
  };
  for (int t = 50; t < kMany; t += 5) EXPECT_NEAR(std::abs(turn(t) - turn(0)), at(t), 0.1f) << t;
}

TEST(Discover, SaysWhatItCannotUse) {
  EXPECT_THROW(discover(sequence(1, [](int) { return bent_arm(0, 1); })), Error);
  try {
    discover(sequence(5, [](int t) { return t == 2 ? bent_arm(0, 1) : Mesh{}; }));
    FAIL() << "four frames without points were used";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("frame 4"), std::string::npos) << error.what();
  }
}

TEST(Discover, EndsEarlyWithTheBestSoFar) {
  DiscoveryOptions options;
  options.progress = [](const DiscoveryProgress& at) { return at.share < 0.5f; };
  const DiscoveredRig rig = discover(bending_arm(), options);
  EXPECT_FALSE(rig.complete);
  EXPECT_EQ(rig.found.motion.poses.size(), static_cast<size_t>(kFrames));
  options.progress = [](const DiscoveryProgress&) { return false; };
  EXPECT_THROW(discover(bending_arm(), options), Error);
}

TEST(RigFollower, LaysAFoundRigOnFurtherScans) {
  const DiscoveredRig& rig = found_arm();
  RigFollower follower(rig.found.rig);
  follower.start_from(rig.found.motion.poses.back());
  float off = 1;
  for (int t = 0; t < 4; ++t)
    off = follower.follow(bent_arm(angle_at(kFrames - 1 - t), 100 + static_cast<uint64_t>(t))).off_m();
  EXPECT_LT(off, 0.02f);
}

TEST(SurfaceGraph, DoesNotCrossAGap) {
  // Two tubes side by side, hardly further apart than neighbouring points.
  constexpr float kApart = 0.08f;
  Rng rng(3);
  Mesh mesh;
  mesh.vertices.resize(6000, 3);
  mesh.vertices.topRows(3000) = tube({0, 0, 0}, {1, 0, 0}, 0.06f, 3000, rng);
  mesh.vertices.bottomRows(3000) = tube({0, kApart, kApart}, {1, kApart, kApart}, 0.06f, 3000, rng);
  ThinnedFrame frame = spread_part(thinned(mesh, 1500, 1500, 1));
  const auto lower = [&](int i) { return frame.points(i, 1) + frame.points(i, 2) < kApart; };
  const auto crossings = [&] {
    const SurfaceGraph graph = surface_graph(frame);
    int count = 0;
    for (size_t i = 0; i < graph.edges.size(); ++i)
      for (const SurfaceGraph::Edge& edge : graph.edges[i])
        count += lower(static_cast<int>(i)) != lower(edge.to);
    return count;
  };
  const int with_normals = crossings();
  frame.normals.setZero();
  EXPECT_LT(3 * with_normals, crossings());  // the points alone do not tell
}

}  // namespace
}  // namespace understudy
