#include "retarget/pipeline/torn_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/performer.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

/// A body of blocks, each of which follows one joint.
struct Blocks {
  Mesh mesh;
  std::vector<int> joint;  // of each vertex
  /// A box of 31 x 31 points a side.
  void add(int follows, const Vec3& low, const Vec3& high) {
    constexpr int kSide = 31;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto first = static_cast<int>(joint.size());
      for (int i = 0; i < kSide * kSide; ++i) {
        Vec3 p = face % 2 > 0 ? high : low;
        p[u] = low[u] + (high[u] - low[u]) * static_cast<float>(i % kSide) / (kSide - 1);
        p[v] = low[v] + (high[v] - low[v]) * static_cast<float>(i / kSide) / (kSide - 1);
        mesh.vertices.conservativeResize(first + i + 1, 3);
        mesh.vertices.row(first + i) = p.transpose();
        joint.push_back(follows);
      }
      for (int i = 0; i < (kSide - 1) * (kSide - 1); ++i) {
        const int at = first + i / (kSide - 1) * kSide + i % (kSide - 1);
        const Eigen::Index f = mesh.faces.rows();
        mesh.faces.conservativeResize(f + 2, 3);
        mesh.faces.row(f) << at, at + 1, at + kSide;
        mesh.faces.row(f + 1) << at + 1, at + kSide + 1, at + kSide;
      }
    }
  }
  RowMatrix weights() const {
    RowMatrix out = RowMatrix::Zero(mesh.vertices.rows(), kJointCount);
    for (size_t v = 0; v < joint.size(); ++v) out(static_cast<Eigen::Index>(v), joint[v]) = 1;
    return out;
  }
};

/// Trunk and left upper arm in human_rest(), which meet at the shoulder.
Blocks trunk_and_arm(int arm_follows) {
  const Joints rest = human_rest();
  const Vec3 S = rest.row(LeftShoulder).transpose(), E = rest.row(LeftElbow).transpose();
  const Vec3 P = rest.row(Pelvis).transpose();
  Blocks blocks;
  blocks.add(Spine3, {-S.x(), P.y() - 0.9f, -0.1f}, {S.x(), S.y() + 0.05f, 0.1f});
  blocks.add(arm_follows, {S.x(), S.y() - 0.05f, -0.05f}, {E.x(), S.y() + 0.05f, 0.05f});
  return blocks;
}

Pose arm_down() {
  Pose pose;
  pose.root = human_rest().row(Pelvis).transpose();
  pose.local[LeftShoulder] = Eigen::AngleAxisf(-1.2f, Vec3::UnitZ()).toRotationMatrix();
  pose.local[RightHip] = Eigen::AngleAxisf(-1.2f, Vec3::UnitX()).toRotationMatrix();
  return pose;
}

float parted(const Blocks& blocks) {
  const TornSurface surface(blocks.mesh, blocks.weights());
  EXPECT_NEAR(surface.parted(blocks.mesh.vertices), 0, 1e-6f);
  return surface.parted(human_rest(), arm_down());
}

TEST(TornSurface, PiecesThatTurnAboutTheirJointHold) {
  EXPECT_EQ(parted(trunk_and_arm(LeftShoulder)), 0);
  EXPECT_EQ(parted(trunk_and_arm(Spine3)), 0);
}

TEST(TornSurface, AnArmOnTheKneeFallsOff) {
  const float share = parted(trunk_and_arm(RightKnee));
  EXPECT_GT(share, 0.2f);  // the arm turns about a hip, a metre away
  EXPECT_LT(share, 2);
}

TEST(TornSurface, SmallPartsAndPartsThatTouchNothingDoNotCount) {
  Blocks blocks = trunk_and_arm(LeftShoulder);
  const Vec3 far(1.5f, 0, 0);
  blocks.add(RightKnee, far, far + Vec3(0.2f, 0.2f, 0.2f));
  EXPECT_EQ(parted(blocks), 0);
}

TEST(TornSurface, ACloudHasNoPieces) {
  Blocks blocks = trunk_and_arm(RightKnee);
  blocks.mesh.faces.resize(0, 3);
  EXPECT_EQ(parted(blocks), 0);
}

TEST(TornSurface, ThePerformerTellsOnce) {
  const Joints rest = human_rest();
  const auto warnings = [&](int arm_follows) {
    const Blocks blocks = trunk_and_arm(arm_follows);
    Performer performer(prepare_target(blocks.mesh, rest), std::make_shared<CopyTransfer>(),
                        std::make_shared<RigidDeformer>(blocks.weights()));
    int count = 0;
    for (int i = 0; i < 20; ++i) {
      Observation seen;
      seen.joints = forward_kinematics(rest, i < 5 ? Pose() : dance(static_cast<float>(i) / 10)).joints;
      const PerformedFrame frame = performer.perform(seen, 1 / 30.0f);
      count += frame.warning.empty() ? 0 : 1;
      EXPECT_TRUE(frame.warning.empty() || frame.warning.find("falls apart") != std::string::npos);
    }
    return count;
  };
  EXPECT_EQ(warnings(LeftShoulder), 0);
  EXPECT_EQ(warnings(RightKnee), 1);
}

}  // namespace
}  // namespace understudy
