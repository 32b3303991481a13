// The 22 body joints (SMPL's order), poses, motions and forward kinematics.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

constexpr int kJointCount = 22;

/// SMPL's body joints. Left is the person's own left, +x in T-pose.
enum Joint : int {
  Pelvis,
  LeftHip,
  RightHip,
  Spine1,
  LeftKnee,
  RightKnee,
  Spine2,
  LeftAnkle,
  RightAnkle,
  Spine3,
  LeftFoot,
  RightFoot,
  Neck,
  LeftCollar,
  RightCollar,
  Head,
  LeftShoulder,
  RightShoulder,
  LeftElbow,
  RightElbow,
  LeftWrist,
  RightWrist
};

/// Parent of each joint, -1 for the pelvis; a parent comes before its children.
constexpr std::array<int, kJointCount> kParents = {-1, 0, 0, 0, 1,  2,  3,  4,  5,  6,  7,
                                                   8,  9, 9, 9, 12, 13, 14, 16, 17, 18, 19};
/// The joint on the other side; its own number for joints of the spine.
constexpr std::array<int, kJointCount> kMirror = {0,  2,  1,  3,  5,  4,  6,  8,  7,  9,  11,
                                                  10, 12, 14, 13, 15, 17, 16, 19, 18, 21, 20};
extern const std::array<const char*, kJointCount> kJointNames;
/// The number of a joint named as in kJointNames, -1 for another name.
int joint_named(std::string_view name);

/// For people: "left wrist" for 20; "all joints" below 0.
std::string joint_label(int joint);
/// Of the bone from the joint's parent to it: "Left forearm" for 20.
std::string bone_label(int joint);

/// Positions of the 22 joints, [22, 3] metres.
using Joints = Eigen::Matrix<float, kJointCount, 3, Eigen::RowMajor>;
using Rotations = std::array<Mat3, kJointCount>;

/// 22 identities.
Rotations identity_rotations();

/// One posture: rotations local (relative to the parent), relative to the T-pose, and the pelvis in the
/// world.
struct Pose {
  Rotations local = identity_rotations();
  Vec3 root = Vec3::Zero();  ///< metres
};

/// Whether the left and the right foot stand on the floor.
using Standing = std::array<bool, 2>;

/// A motion, one pose a frame.
struct Motion {
  float fps = 30;
  std::vector<Pose> poses;
  std::vector<uint8_t> flags;        ///< per frame, 0 = good; empty = all good
  std::vector<Standing> standing{};  ///< per frame, the feet that are held on the floor; empty: not known
  /// Per frame how far its joints are expected to be off on average, metres, where it was made and not seen;
  /// 0 where it was seen; empty: all was.
  std::vector<float> doubt_m{};
};

/// A pose in the world.
struct PosedSkeleton {
  Rotations global;  ///< world rotation of each joint's frame
  Joints joints;     ///< world positions, metres
};

/// World rotations and positions of the joints of a body whose T-pose joints are `rest`.
PosedSkeleton forward_kinematics(const Joints& rest, const Pose& pose);

/// World rotations from local ones.
Rotations global_rotations(const Rotations& local);
/// The inverse.
Rotations local_rotations(const Rotations& global);

/// Local rotations of a body that turns from another rest pose as `local` turns from the T-pose. `rest`:
/// local rotations of that pose against the T-pose. With global rotations R of `local` and P of `rest` those
/// of the result are R_j P_j: where the source is in T-pose the body is in its rest pose,
/// as in an IK retargeter.
Rotations from_rest_pose(const Rotations& local, const Rotations& rest);

/// Thigh plus shin in metres, mean of both sides. Bone lengths do not change with pose: any pose will do.
float leg_length(const Joints& joints);
/// The same of upper arm plus forearm.
float arm_length(const Joints& joints);

/// The same pose seen in a mirror (x -> -x in the T-pose frame): sides exchanged, rotations reflected.
Pose mirrored(const Pose& pose);

}  // namespace understudy
