#include "retarget/editing/limb_move.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

void add_rotation(const RotateEdit& more, std::vector<RotateEdit>& edits) {
  const auto of_joint = [&](const RotateEdit& edit) { return edit.joint == more.joint; };
  const auto last = std::find_if(edits.rbegin(), edits.rend(), of_joint);
  const bool continues = last != edits.rend() && last->frame == more.frame && last->falloff == more.falloff &&
                         last->limb == more.limb;
  if (!continues) return edits.push_back(more);
  last->axis_angle = rotation_to_axis_angle(rotation_from_axis_angle(last->axis_angle) *
                                            rotation_from_axis_angle(more.axis_angle));
}

}  // namespace

int limb_end(int joint) {
  switch (joint) {
    case LeftWrist:
    case RightWrist:
    case LeftAnkle:
    case RightAnkle:
      return joint;
    case LeftFoot:
    case RightFoot:
      return kParents[joint];
    default:
      return -1;
  }
}

bool is_leg(int joint) {
  return limb_end(joint) == LeftAnkle || limb_end(joint) == RightAnkle;
}

std::vector<int> joints_turned_by(int joint) {
  const int end = limb_end(joint);
  if (end < 0) return {joint};
  std::vector<int> joints = {kParents[kParents[end]], kParents[end], end};
  if (joint != end) joints.push_back(joint);
  return joints;
}

std::string limb_label(int joint) {
  const int end = limb_end(joint);
  if (end < 0) return joint_label(joint);
  return std::string(kMirror[end] > end ? "left " : "right ") + (is_leg(end) ? "leg" : "arm");
}

std::string limb_end_label(int joint) {
  const int end = limb_end(joint);
  US_CHECK(end >= 0, "joint ", joint, " ends no limb");
  return std::string(kMirror[end] > end ? "left " : "right ") + (is_leg(end) ? "foot" : "hand");
}

Pose moved_limb(const Joints& rest, int joint, const Vec3& offset, Pose pose) {
  const int end = limb_end(joint);
  US_CHECK(end >= 0, "joint ", joint, " ends no limb");
  US_CHECK(offset.allFinite(), "a limb is moved by a distance that is not finite");
  const Vec3 to = forward_kinematics(rest, pose).joints.row(end).transpose() + offset;
  if (is_leg(end))
    place_ankle(rest, end - LeftAnkle, to, pose);
  else
    place_wrist(rest, end - LeftWrist, to, pose);
  return pose;
}

void add_limb_move(const LimbMove& move, const Pose& performed, const Joints& rest, PoseEdits& edits) {
  constexpr float kLeast = 1e-4f;  // radians
  const Mat3 heading = rotation_about_y(edits.turn ? edits.turn->turn_deg * kPi / 180 : 0);
  const Pose before = rotated(edits.rotate, move.frame, performed);
  const Pose after = moved_limb(rest, move.joint, heading.transpose() * move.offset, before);
  for (const int j : joints_turned_by(move.joint)) {
    const Vec3 turn = rotation_to_axis_angle(before.local[j].transpose() * after.local[j]);
    if (turn.norm() > kLeast)
      add_rotation({move.frame, j, turn, move.falloff, limb_end(move.joint)}, edits.rotate);
  }
}

}  // namespace understudy
