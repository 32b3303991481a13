#include "retarget/metrics/registered_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

/// A registered body without cloth: rings of vertices about every bone, each moved rigidly with its bone.
class RigidBody {
 public:
  RigidBody() {
    Rng rng(5);
    const Joints& rest = human_rest();
    for (int j = 0; j < kJointCount; ++j)
      for (int i = 0; i < 150; ++i) {
        const Vec3 from = rest.row(j).transpose();
        add(j, from + rng.uniform(0.05f, 1) * way(j) + Vec3(jitter(rng), jitter(rng), jitter(rng)));
      }
  }
  PosedSkeleton bones(int frame) const {
    Pose pose;
    pose.root = Vec3(0.03f * frame, 0.9f, 0);
    for (int j = 0; j < kJointCount; ++j)
      pose.local[j] = rotation_from_axis_angle(
          Vec3(0.05f * frame * std::sin(1.3f * j), 0.07f * frame * std::cos(2.1f * j), 0.04f * frame));
    pose.local[LeftFoot] = pose.local[RightFoot] = Mat3::Identity();  // shoes: toes do not bend
    return forward_kinematics(human_rest(), pose);
  }
  Points vertices(const PosedSkeleton& posed) const {
    Points out(offsets_.size(), 3);
    for (size_t v = 0; v < offsets_.size(); ++v)
      out.row(static_cast<Eigen::Index>(v)) =
          posed.joints.row(bone_[v]) + (posed.global[bone_[v]] * offsets_[v]).transpose();
    return out;
  }

 private:
  static float jitter(Rng& rng) { return rng.uniform(-0.04f, 0.04f); }
  /// To the joint at the bone's other end; of leaves as far as flesh goes.
  static Vec3 way(int j) {
    for (int end = kJointCount - 1; end > j; --end)
      if (kParents[end] == j) return (human_rest().row(end) - human_rest().row(j)).transpose();
    return 0.4f * (human_rest().row(j) - human_rest().row(kParents[j])).transpose();
  }
  void add(int j, const Vec3& place) {
    bone_.push_back(j);
    offsets_.push_back(place - human_rest().row(j).transpose());
  }
  std::vector<int> bone_;
  std::vector<Vec3> offsets_;
};

const PartFigures& part(const std::vector<PartFigures>& parts, const char* name) {
  for (const PartFigures& one : parts)
    if (std::strcmp(one.part, name) == 0) return one;
  throw Error(std::string("no part ") + name);
}

/// Five frames; `change` spoils what is said of each frame but the first.
template <class Change>
std::vector<PartFigures> judged(const Change& change) {
  const RigidBody body;
  RegisteredTruth truth;
  for (int frame = 0; frame < 5; ++frame) {
    const PosedSkeleton bones = body.bones(frame);
    PosedSkeleton told = bones;
    if (frame > 0) change(told);
    truth.push(body.vertices(bones), told.joints, told.global);
  }
  return truth.parts();
}

TEST(RegisteredTruth, FindsNoFaultWithTheBonesThemselves) {
  const std::vector<PartFigures> parts = judged([](PosedSkeleton&) {});
  EXPECT_EQ(parts.size(), 15u);
  for (const char* name : {"left_shin", "right_forearm", "left_hand", "right_foot", "head"}) {
    EXPECT_NEAR(part(parts, name).rot_deg, 0, 0.3) << name;
    EXPECT_NEAR(part(parts, name).fit_mm, 0, 1) << name;
    for (const double mm : part(parts, name).const_mm) EXPECT_NEAR(mm, 0, 1) << name;
  }
}

TEST(RegisteredTruth, TellsByHowMuchABoneIsTurnedWrongly) {
  const Mat3 wrong = rotation_from_axis_angle(Vec3(0, 20 * kPi / 180, 0));
  const std::vector<PartFigures> parts = judged([&](PosedSkeleton& told) {
    told.global[LeftKnee] = told.global[LeftKnee] * wrong;  // the shin, about itself
    told.global[RightWrist] = wrong * told.global[RightWrist];
  });
  EXPECT_NEAR(part(parts, "left_shin").rot_deg, 20, 0.3);
  EXPECT_NEAR(part(parts, "right_hand").rot_deg, 20, 0.3);
  EXPECT_NEAR(part(parts, "right_hand").rot_p95_deg, 20, 0.3);
  EXPECT_NEAR(part(parts, "right_shin").rot_deg, 0, 0.3);
  const std::vector<PartFigures> right = judged([](PosedSkeleton&) {});
  EXPECT_NEAR(mean_rot_deg(parts) - mean_rot_deg(right), 40.0 / 15, 0.1);
}

TEST(RegisteredTruth, TellsHowFarAJointWandersInItsPart) {
  float way = 0.02f;
  const std::vector<PartFigures> parts = judged([&](PosedSkeleton& told) {
    told.joints.row(LeftElbow) += way * told.global[LeftElbow].col(1).transpose();
    way = -way;  // two frames above, two below, the first in the middle: 16 mm on average
  });
  const PartFigures& forearm = part(parts, "left_forearm");
  ASSERT_EQ(forearm.joints.front(), LeftElbow);
  EXPECT_NEAR(forearm.const_mm.front(), 16, 1);
  EXPECT_NEAR(forearm.const_mm.back(), 0, 1);
}

TEST(RegisteredTruth, NeedsOneTopologyAndTwoFrames) {
  const RigidBody body;
  const PosedSkeleton bones = body.bones(0);
  RegisteredTruth truth;
  truth.push(body.vertices(bones), bones.joints, bones.global);
  EXPECT_TRUE(truth.parts().empty());
  EXPECT_THROW(truth.push(body.vertices(bones).topRows(9), bones.joints, bones.global), Error);
}

}  // namespace
}  // namespace understudy
