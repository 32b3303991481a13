#include "retarget/body/joint_sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace understudy {
namespace {

constexpr float kAboutLimb = 0.1f, kAboutTrunk = 0.2f;  // leg lengths
constexpr float kEnough = 0.2f;                         // of what is left about the joint seen best
constexpr float kFarAway = 10.0f;                       // leg lengths, where nobody is in the cloud

/// Joints with much flesh about them: those of the spine lie by the back, and are seen from the front as
/// well.
bool is_in_trunk(int joint) {
  return joint <= Spine1 || joint == Spine2 || joint == Spine3 || (joint >= Neck && joint <= Head);
}

/// The joints at a part's ends: its own and its children's.
const std::array<std::vector<int>, kJointCount>& joints_of_parts() {
  static const auto joints = [] {
    std::array<std::vector<int>, kJointCount> made;
    for (int j = 0; j < kJointCount; ++j) {
      made[j].push_back(j);
      if (kParents[j] >= 0) made[kParents[j]].push_back(j);
    }
    return made;
  }();
  return joints;
}

}  // namespace

PerJoint surface_about_joints(const LabelledPoints& cloud, const PosedSkeleton& truth) {
  const float leg = leg_length(truth.joints);
  PerJoint scale, surface = PerJoint::Zero();
  for (int j = 0; j < kJointCount; ++j)
    scale[j] = -1 / std::pow(leg * (is_in_trunk(j) ? kAboutTrunk : kAboutLimb), 2.0f);
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    if (cloud.parts[i] >= kJointCount) continue;
    for (const int j : joints_of_parts()[cloud.parts[i]])
      surface[j] += std::exp(scale[j] * (cloud.points.row(i) - truth.joints.row(j)).squaredNorm());
  }
  return surface;
}

JointSight joint_sight(const PerJoint& whole, const LabelledPoints& cloud, const PosedSkeleton& truth) {
  const PerJoint left = surface_about_joints(cloud, truth) / whole.max(1e-6f);
  const float enough = kEnough * std::clamp(left.maxCoeff(), 1e-6f, 1.0f);
  JointSight sight;
  sight.seen = (left >= enough).cast<float>();
  PerJoint squared = PerJoint::Constant(std::numeric_limits<float>::max());
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i)
    if (cloud.parts[i] < kJointCount)
      squared = squared.min((truth.joints.rowwise() - cloud.points.row(i)).rowwise().squaredNorm().array());
  sight.away = (squared.sqrt() / leg_length(truth.joints)).min(kFarAway);
  return sight;
}

}  // namespace understudy
