#include "retarget/skeleton/skeleton.hpp"

#include <algorithm>

namespace understudy {
namespace {

/// The two bones above a limb's end, mean of both sides.
float limb_length(const Joints& joints, int left_end) {
  float sum = 0;
  for (const int end : {left_end, kMirror[left_end]})
    for (const int j : {kParents[end], end}) sum += (joints.row(j) - joints.row(kParents[j])).norm();
  return 0.5f * sum;
}

}  // namespace

const std::array<const char*, kJointCount> kJointNames = {
    "pelvis",     "left_hip",    "right_hip",    "spine1",     "left_knee",     "right_knee",
    "spine2",     "left_ankle",  "right_ankle",  "spine3",     "left_foot",     "right_foot",
    "neck",       "left_collar", "right_collar", "head",       "left_shoulder", "right_shoulder",
    "left_elbow", "right_elbow", "left_wrist",   "right_wrist"};

int joint_named(std::string_view name) {
  const auto at = std::find(kJointNames.begin(), kJointNames.end(), name);
  return at == kJointNames.end() ? -1 : static_cast<int>(at - kJointNames.begin());
}

std::string joint_label(int joint) {
  if (joint < 0 || joint >= kJointCount) return "all joints";
  std::string label = kJointNames[joint];
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

std::string bone_label(int joint) {
  static const std::array<const char*, kJointCount> kBones = {
      "Pelvis",       "Left hip bone",   "Right hip bone",   "Lower spine",    "Left thigh",
      "Right thigh",  "Middle spine",    "Left shin",        "Right shin",     "Upper spine",
      "Left foot",    "Right foot",      "Upper chest",      "Left chest",     "Right chest",
      "Neck",         "Left collarbone", "Right collarbone", "Left upper arm", "Right upper arm",
      "Left forearm", "Right forearm"};
  return kBones.at(joint);
}

Rotations identity_rotations() {
  Rotations rotations;
  rotations.fill(Mat3::Identity());
  return rotations;
}

PosedSkeleton forward_kinematics(const Joints& rest, const Pose& pose) {
  PosedSkeleton posed;
  posed.global = global_rotations(pose.local);
  posed.joints.row(Pelvis) = pose.root.transpose();
  for (int j = Pelvis + 1; j < kJointCount; ++j) {
    const int p = kParents[j];
    const Vec3 bone = (rest.row(j) - rest.row(p)).transpose();
    posed.joints.row(j) = posed.joints.row(p) + (posed.global[p] * bone).transpose();
  }
  return posed;
}

Rotations global_rotations(const Rotations& local) {
  Rotations global;
  for (int j = 0; j < kJointCount; ++j)
    global[j] = kParents[j] < 0 ? local[j] : Mat3(global[kParents[j]] * local[j]);
  return global;
}

Rotations local_rotations(const Rotations& global) {
  Rotations local;
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    local[j] = p < 0 ? global[j] : Mat3(global[p].transpose() * global[j]);
  }
  return local;
}

Rotations from_rest_pose(const Rotations& local, const Rotations& rest) {
  Rotations global = global_rotations(local);
  const Rotations turned = global_rotations(rest);
  for (int j = 0; j < kJointCount; ++j) global[j] = global[j] * turned[j];
  return local_rotations(global);
}

float leg_length(const Joints& joints) {
  return limb_length(joints, LeftAnkle);
}

float arm_length(const Joints& joints) {
  return limb_length(joints, LeftWrist);
}

Pose mirrored(const Pose& pose) {
  const Eigen::DiagonalMatrix<float, 3> flip(-1.0f, 1.0f, 1.0f);
  Pose result;
  for (int j = 0; j < kJointCount; ++j) result.local[j] = flip * pose.local[kMirror[j]] * flip;
  result.root = flip * pose.root;
  return result;
}

}  // namespace understudy
