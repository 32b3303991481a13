#include "retarget/pipeline/arm_reach.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

Vec3 between_shoulders(const Joints& joints) {
  return 0.5f * (joints.row(LeftShoulder) + joints.row(RightShoulder)).transpose();
}

}  // namespace

Pose ArmReach::push(const Pose& pose, const Joints& rest, const Joints& source) {
  if (reach_ <= 0) return pose;
  US_CHECK(source.allFinite(), "the source's joints are not finite");
  arm_a_.push(arm_length(source));
  const float ratio = arm_length(rest) / std::max(arm_a_.value(), 1e-4f);
  const Joints joints = forward_kinematics(rest, pose).joints;
  const Vec3 from_a = between_shoulders(source), from_b = between_shoulders(joints);
  Pose result = pose;
  for (const int side : {0, 1}) {
    const Vec3 wrist = joints.row(LeftWrist + side).transpose();
    const Vec3 seen = source.row(LeftWrist + side).transpose();
    const Vec3 wanted = from_b + ratio * (seen - from_a);
    place_wrist(rest, side, wrist + reach_ * (wanted - wrist), result);
  }
  return result;
}

}  // namespace understudy
