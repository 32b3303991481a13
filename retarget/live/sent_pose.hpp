// What goes out of a performed frame: as the VMC protocol's bones, and as plain OSC joints.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "retarget/live/osc_socket.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The target in one frame.
struct SentPose {
  int64_t number = 0;
  double seconds = 0;  ///< since the first frame
  Pose pose;
  Joints joints = Joints::Zero();  ///< world, metres
  Eigen::Array<float, kJointCount, 1> confidence =
      Eigen::Array<float, kJointCount, 1>::Zero();  ///< of the joints that were observed, 0..1
  bool is_tracked = true;                           ///< false: the source is not seen now
  double age_ms = 0;                                ///< since it was captured; 0: not known
};

/// What VRM, and Unity, call the 22 joints.
extern const std::array<const char*, kJointCount> kVrmBones;

/// A bone relative to its parent, and how it is turned against the T-pose; left-handed as Unity is: x to the
/// person's right, y up, z forward.
struct VmcBone {
  const char* name = "";
  Vec3 position = Vec3::Zero();  ///< metres
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
};
/// The root, which stands on the floor under the pelvis and does not turn, then the 22 bones. rest: the
/// target's T-pose.
std::vector<VmcBone> vmc_bones(const Joints& rest, const Pose& pose);

/// /VMC/Ext/OK, /VMC/Ext/T, /VMC/Ext/Root/Pos and 22 /VMC/Ext/Bone/Pos.
std::vector<OscMessage> vmc_messages(const Joints& rest, const SentPose& sent);
/// /understudy/frame number seconds age_ms tracked, then 22 /understudy/joint name x y z confidence.
std::vector<OscMessage> joint_messages(const SentPose& sent);

/// Lets a target whose source is lost come to stand in T-pose, where it was and turned as it was, and go on
/// from there smoothly when the source is back.
class TPoseBlend {
 public:
  /// hip_height_m: of the standing target's pelvis over its soles.
  explicit TPoseBlend(float hip_height_m) : hip_height_m_(hip_height_m) {}
  /// The pose that is sent in place of this one, dt seconds after the one before.
  Pose push(const Pose& pose, bool is_tracked, float dt);

  static constexpr float kPatience_s = 2, kLeaving_s = 1.5f, kReturning_s = 0.5f;

 private:
  float hip_height_m_;
  float lost_s_ = 0, share_ = 0;  // of the T-pose
};

}  // namespace understudy
