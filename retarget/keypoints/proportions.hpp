// How long a person's bones are in a picture.
#pragma once

#include <array>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// Of BODY_25's points, the first: those of Zheng et al. (2021).
constexpr int kPaperPoints = 15;
constexpr int kFlatBoneCount = 14;

/// Bones between the first 15 points of BODY_25, outwards from the mid-hip: a bone's `from` is the `to` of
/// one before it, or the mid-hip.
struct FlatBone {
  int from, to;
  const char* name;   ///< of a file's key: "left_thigh"
  const char* label;  ///< for people: "Left thigh"
};
constexpr std::array<FlatBone, kFlatBoneCount> kFlatBones = {{
    {body25::MidHip, body25::Neck, "trunk", "Trunk"},
    {body25::Neck, body25::Nose, "head", "Head"},
    {body25::Neck, body25::RightShoulder, "right_shoulder", "Right shoulder"},
    {body25::Neck, body25::LeftShoulder, "left_shoulder", "Left shoulder"},
    {body25::RightShoulder, body25::RightElbow, "right_upper_arm", "Right upper arm"},
    {body25::LeftShoulder, body25::LeftElbow, "left_upper_arm", "Left upper arm"},
    {body25::RightElbow, body25::RightWrist, "right_forearm", "Right forearm"},
    {body25::LeftElbow, body25::LeftWrist, "left_forearm", "Left forearm"},
    {body25::MidHip, body25::RightHip, "right_hip", "Right hip"},
    {body25::MidHip, body25::LeftHip, "left_hip", "Left hip"},
    {body25::RightHip, body25::RightKnee, "right_thigh", "Right thigh"},
    {body25::LeftHip, body25::LeftKnee, "left_thigh", "Left thigh"},
    {body25::RightKnee, body25::RightAnkle, "right_shin", "Right shin"},
    {body25::LeftKnee, body25::LeftAnkle, "left_shin", "Left shin"},
}};
namespace flat_bone {
enum Bone : int {
  Trunk,
  Head,
  RightShoulder,
  LeftShoulder,
  RightUpperArm,
  LeftUpperArm,
  RightForearm,
  LeftForearm,
  RightHip,
  LeftHip,
  RightThigh,
  LeftThigh,
  RightShin,
  LeftShin
};
}  // namespace flat_bone
/// The bone on the other side; its own number for trunk and head.
constexpr std::array<int, kFlatBoneCount> kFlatBoneMirror = {0, 1, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12};

using BoneLengths = Eigen::Array<float, kFlatBoneCount, 1>;  ///< one for each of kFlatBones

/// A person's lengths, pixels of the picture that they stand in, as long as a bone looks where it lies across
/// the view.
struct Proportions {
  BoneLengths length = BoneLengths::Ones();
  BoneLengths doubt = BoneLengths::Zero();  ///< standard deviation of the logarithm; 0: known
  int poses = 0;                            ///< that were looked at; 0: none, they come from elsewhere
};

/// How long the bones look in one pose, pixels; 0 where an end is missing.
BoneLengths seen_lengths(const FlatPose& pose);
/// From the head to the ankles of who stands upright, about: what other lengths are measured by.
float stature_of(const BoneLengths& length);
/// Mean of both thighs and shins, one after the other.
float leg_of(const BoneLengths& length);

}  // namespace understudy
