#include "retarget/live/sent_pose.hpp"

#include <algorithm>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// Of the mirror x -> -x, which turns a right-handed world into a left-handed one.
Vec3 left_handed(const Vec3& v) {
  return {-v.x(), v.y(), v.z()};
}
Eigen::Quaternionf left_handed(const Mat3& R) {
  const Eigen::Quaternionf q(R);
  return {q.w(), q.x(), -q.y(), -q.z()};
}

OscMessage message_of(const char* path, const VmcBone& bone) {
  const Vec3& p = bone.position;
  const Eigen::Quaternionf& q = bone.rotation;
  return {path, {std::string(bone.name), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}};
}

Mat3 between(const Mat3& a, const Mat3& b, float share) {
  return Eigen::Quaternionf(a).slerp(share, Eigen::Quaternionf(b)).toRotationMatrix();
}

}  // namespace

const std::array<const char*, kJointCount> kVrmBones = {
    "Hips",         "LeftUpperLeg",  "RightUpperLeg", "Spine",      "LeftLowerLeg", "RightLowerLeg",
    "Chest",        "LeftFoot",      "RightFoot",     "UpperChest", "LeftToes",     "RightToes",
    "Neck",         "LeftShoulder",  "RightShoulder", "Head",       "LeftUpperArm", "RightUpperArm",
    "LeftLowerArm", "RightLowerArm", "LeftHand",      "RightHand"};

std::vector<VmcBone> vmc_bones(const Joints& rest, const Pose& pose) {
  std::vector<VmcBone> bones;
  bones.push_back(
      {"root", left_handed(Vec3(pose.root.x(), 0, pose.root.z())), Eigen::Quaternionf::Identity()});
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    const Vec3 offset = p < 0 ? Vec3(0, pose.root.y(), 0) : Vec3((rest.row(j) - rest.row(p)).transpose());
    bones.push_back({kVrmBones[j], left_handed(offset), left_handed(pose.local[j])});
  }
  return bones;
}

std::vector<OscMessage> vmc_messages(const Joints& rest, const SentPose& sent) {
  // Loaded; calibrated; a usual mode; whether it is tracked.
  std::vector<OscMessage> messages = {{"/VMC/Ext/OK", {1, 3, 0, sent.is_tracked ? 1 : 0}},
                                      {"/VMC/Ext/T", {static_cast<float>(sent.seconds)}}};
  const char* path = "/VMC/Ext/Root/Pos";
  for (const VmcBone& bone : vmc_bones(rest, sent.pose)) {
    messages.push_back(message_of(path, bone));
    path = "/VMC/Ext/Bone/Pos";
  }
  return messages;
}

std::vector<OscMessage> joint_messages(const SentPose& sent) {
  std::vector<OscMessage> messages = {{"/understudy/frame",
                                       {static_cast<int32_t>(sent.number), static_cast<float>(sent.seconds),
                                        static_cast<float>(sent.age_ms), sent.is_tracked ? 1 : 0}}};
  for (int j = 0; j < kJointCount; ++j)
    messages.push_back({"/understudy/joint",
                        {std::string(kJointNames[j]), sent.joints(j, 0), sent.joints(j, 1), sent.joints(j, 2),
                         sent.confidence[j]}});
  return messages;
}

Pose TPoseBlend::push(const Pose& pose, bool is_tracked, float dt) {
  lost_s_ = is_tracked ? 0 : lost_s_ + dt;
  const float step = lost_s_ > kPatience_s ? dt / kLeaving_s : is_tracked ? -dt / kReturning_s : 0;
  share_ = std::clamp(share_ + step, 0.0f, 1.0f);
  if (share_ == 0) return pose;
  const float eased = share_ * share_ * (3 - 2 * share_);
  Pose shown = pose;
  shown.root.y() += eased * (hip_height_m_ - pose.root.y());
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3 rest = j == Pelvis ? rotation_about_y(heading_of(pose.local[j])) : Mat3(Mat3::Identity());
    shown.local[j] = between(pose.local[j], rest, eased);
  }
  return shown;
}

}  // namespace understudy
