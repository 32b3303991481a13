#include "retarget/editing/pose_fill.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

constexpr float kRest_s = 0.15f;       // in which a movement that nothing is known of loses most of its speed
constexpr float kSamePlace_m = 0.05f;  // that the ankle of a standing foot moves at most, leg 0.8 m
constexpr float kFullTurn = 2 * kPi;

/// A pose seen from another: 22 rotation vectors and the root's way.
using Steps = Eigen::Matrix<float, kJointCount + 1, 3, Eigen::RowMajor>;

/// Each rotation vector the nearest to `near` of those that mean the same rotation.
Vec3 unwrapped(const Vec3& turn, const Vec3& near) {
  const float angle = turn.norm();
  if (angle < 1e-4f) return turn;
  const Vec3 axis = turn / angle;
  return turn + kFullTurn * std::round((near.dot(axis) - angle) / kFullTurn) * axis;
}

Steps steps_from(const Pose& origin, const Pose& pose, const Steps& near) {
  Steps steps;
  for (int j = 0; j < kJointCount; ++j) {
    const Vec3 turn = rotation_to_axis_angle(origin.local[j].transpose() * pose.local[j]);
    steps.row(j) = unwrapped(turn, near.row(j));
  }
  steps.row(kJointCount) = pose.root - origin.root;
  return steps;
}

Pose stepped(const Pose& origin, const Steps& steps) {
  Pose pose;
  for (int j = 0; j < kJointCount; ++j)
    pose.local[j] = origin.local[j] * rotation_from_axis_angle(steps.row(j));
  pose.root = origin.root + steps.row(kJointCount).transpose();
  return pose;
}

/// The cubic with values a, b and slopes (per unit of t) u, v at t = 0, 1.
Steps hermite(const Steps& a, const Steps& u, const Steps& b, const Steps& v, float t) {
  const float t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * u + (3 * t2 - 2 * t3) * b + (t3 - t2) * v;
}

void fill_between(int before, int after, Motion& motion) {
  const Pose& origin = motion.poses[before];
  const int count = ssize(motion.poses);
  const float length = static_cast<float>(after - before);
  const Steps none = Steps::Zero(), end = steps_from(origin, motion.poses[after], none);
  Steps leaving = end / length, coming = end / length;
  if (before > 0) leaving = -steps_from(origin, motion.poses[before - 1], none);
  if (after + 1 < count) coming = steps_from(origin, motion.poses[after + 1], end) - end;
  for (int t = before + 1; t < after; ++t) {
    const float at = static_cast<float>(t - before) / length;
    motion.poses[t] = stepped(origin, hermite(none, length * leaving, end, length * coming, at));
  }
}

/// From the known frame `from` on, in the direction of `step` (1 or -1), frame for frame to `to`.
void predict(int from, int step, int to, Motion& motion) {
  const Pose origin = motion.poses[from];
  const int past = from - step;
  const bool is_known = past >= 0 && past < ssize(motion.poses);
  const Steps none = Steps::Zero();
  const Steps speed = is_known ? Steps(-steps_from(origin, motion.poses[past], none)) : none;
  const float slowing = kRest_s * motion.fps;  // frames
  for (int t = from + step; t != to + step; t += step) {
    const float way = slowing * (1 - std::exp(-static_cast<float>(std::abs(t - from)) / slowing));
    motion.poses[t] = stepped(origin, way * speed);
  }
}

void hold_foot(int side, int before, int after, const Joints& rest, Motion& motion) {
  const int ankle = Leg::of(side).ankle;
  const auto ankle_at = [&](int t) -> Vec3 {
    return forward_kinematics(rest, motion.poses[t]).joints.row(ankle).transpose();
  };
  const Vec3 from = ankle_at(before), to = ankle_at(after);
  if ((to - from).norm() > kSamePlace_m * leg_length(rest) / 0.8f) return;
  for (int t = before + 1; t < after; ++t) {
    const float share = static_cast<float>(t - before) / static_cast<float>(after - before);
    place_ankle(rest, side, from + share * (to - from), motion.poses[t]);
    motion.standing[t][side] = true;
  }
}

}  // namespace

void fill_frames(const FillEdit& fill, const Joints& rest, Motion& motion) {
  const int count = ssize(motion.poses), before = fill.first - 1, after = fill.last + 1;
  US_CHECK(fill.first >= 0 && fill.first <= fill.last && fill.last < count, "frames ", fill.first, " to ",
           fill.last, " cannot be filled: the motion has frames 0 to ", count - 1);
  US_CHECK(before >= 0 || after < count, "all frames are to be filled: none is left that is known");
  if (!motion.standing.empty())
    for (int t = fill.first; t <= fill.last; ++t) motion.standing[t] = {};
  if (after >= count) return predict(before, 1, fill.last, motion);
  if (before < 0) return predict(after, -1, fill.first, motion);
  fill_between(before, after, motion);
  if (motion.standing.empty()) return;
  for (int side = 0; side < 2; ++side)
    if (motion.standing[before][side] && motion.standing[after][side])
      hold_foot(side, before, after, rest, motion);
}

}  // namespace understudy
