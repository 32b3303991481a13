#include "retarget/baselines/node_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "tests/support/moving_arm.hpp"

namespace understudy {
namespace {

std::vector<Points> frames_of(const RiggedMotion& performed) {
  std::vector<Points> frames;
  for (const Mesh& scan : test::scans_of(performed)) frames.push_back(scan.vertices);
  return frames;
}

TEST(NodeRig, StartsAsTheFirstFrame) {
  const auto frames = frames_of(test::bending_arm(5));
  const RiggedMotion found = node_rig(frames, 25, 12);
  EXPECT_NO_THROW(check_rig(found.rig));
  EXPECT_EQ(found.rig.count(), 12);
  EXPECT_EQ(found.motion.fps, 25);
  ASSERT_EQ(found.motion.poses.size(), 5u);
  const Points posed =
      skinned(found.rig.surface.vertices, found.rig.skin, bone_motions(found.rig, found.motion.poses[0]));
  EXPECT_LT((posed - frames[0]).cwiseAbs().maxCoeff(), 2e-4f);
}

TEST(NodeRig, HangsOnItsNeighbour) {
  Points line(4, 3);
  line << 0, 0, 0, 3, 0, 0, 1, 0, 0, 2, 0, 0;
  const RiggedMotion found = node_rig({line}, 30, 9);  // all four are nodes
  ASSERT_EQ(found.rig.count(), 4);
  for (int j = 1; j < 4; ++j) {
    EXPECT_EQ(found.rig.joints[j].parent, j - 1);
    EXPECT_EQ(found.rig.joints[j].rest.x(), static_cast<float>(j));
  }
}

TEST(NodeRig, TurnsWithWhatItCarries) {
  Points straight(3, 3), bent(3, 3);
  straight << 0, 0, 0, 1, 0, 0, 2, 0, 0;
  bent << 0, 0, 0, 1, 0, 0, 1 + std::cos(0.5f), std::sin(0.5f), 0;
  const RiggedMotion found = node_rig({straight, bent}, 30, 3);
  const Points posed =
      skinned(found.rig.surface.vertices, found.rig.skin, bone_motions(found.rig, found.motion.poses[1]));
  EXPECT_LT((posed - bent).cwiseAbs().maxCoeff(), 1e-3f);
}

TEST(NodeRig, RefusesEmptyFrames) {
  EXPECT_THROW(node_rig({}, 30), Error);
  EXPECT_THROW(node_rig({Points(0, 3)}, 30), Error);
  EXPECT_THROW(node_rig({Points::Zero(4, 3), Points::Constant(2, 3, NAN)}, 30), Error);
}

}  // namespace
}  // namespace understudy
