#include "retarget/editing/pose_edits.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

double mean_acceleration(const std::vector<Joints>& x, float fps) {
  if (x.size() < 3) return 0;
  double sum = 0;
  for (size_t t = 1; t + 1 < x.size(); ++t)
    sum += (x[t + 1] - 2 * x[t] + x[t - 1]).cast<double>().rowwise().norm().sum();
  return sum * fps * fps / (static_cast<double>(x.size() - 2) * kJointCount);
}

std::vector<Joints> joints_over_time(const Motion& motion, const Joints& rest) {
  std::vector<Joints> result;
  for (const Pose& pose : motion.poses) result.push_back(forward_kinematics(rest, pose).joints);
  return result;
}

void check(const Motion& motion) {
  US_CHECK(motion.fps > 0 && std::isfinite(motion.fps), "a motion cannot have ", motion.fps,
           " frames a second");
  US_CHECK(motion.flags.empty() || motion.flags.size() == motion.poses.size(), "a motion has ",
           motion.flags.size(), " flags for ", motion.poses.size(), " frames");
  US_CHECK(motion.standing.empty() || motion.standing.size() == motion.poses.size(), "a motion has ",
           motion.standing.size(), " frames' contacts for ", motion.poses.size(), " frames");
}

void check(const RotateEdit& edit) {
  US_CHECK(edit.joint >= 0 && edit.joint < kJointCount, "a rotated bone has number ", edit.joint,
           ", there are ", kJointCount);
  US_CHECK(edit.axis_angle.allFinite(), "a bone is rotated by an angle that is not finite");
}

/// A foot that its limb was turned away from where it stood stands no longer.
void forget_contacts(const Motion& before, const Joints& rest, Motion& after) {
  constexpr float kAway = 0.02f;  // metres, leg 0.8 m
  const float away = kAway * leg_length(rest) / 0.8f;
  for (size_t t = 0; t < after.standing.size(); ++t) {
    if (before.poses[t].local == after.poses[t].local) continue;
    const Joints was = forward_kinematics(rest, before.poses[t]).joints;
    const Joints is = forward_kinematics(rest, after.poses[t]).joints;
    for (int side = 0; side < 2; ++side)
      if ((is.row(LeftFoot + side) - was.row(LeftFoot + side)).norm() > away) after.standing[t][side] = false;
  }
}

void rotate(const std::vector<RotateEdit>& edits, const Joints& rest, Motion& motion) {
  if (edits.empty()) return;
  const Motion before = motion;
  for (size_t t = 0; t < motion.poses.size(); ++t)
    motion.poses[t] = rotated(edits, t, std::move(motion.poses[t]));
  forget_contacts(before, rest, motion);
}

void smooth(const SmoothEdit& edit, Motion& motion) {
  const std::vector<float> half = half_gaussian(edit.strength, motion.fps);
  std::vector<Mat3> turns(motion.poses.size());
  for (int j = 0; j < kJointCount; ++j) {
    for (size_t t = 0; t < turns.size(); ++t) turns[t] = motion.poses[t].local[j];
    turns = filtered_rotations(turns, half);
    for (size_t t = 0; t < turns.size(); ++t) motion.poses[t].local[j] = turns[t];
  }
  std::vector<Vec3> roots;
  for (const Pose& pose : motion.poses) roots.push_back(pose.root);
  const std::vector<Vec3> mean = filtered(roots, half);
  for (size_t t = 0; t < roots.size(); ++t) motion.poses[t].root = mean[t];
}

void turn(const TurnEdit& edit, Motion& motion) {
  if (motion.poses.empty() || edit.turn_deg == 0) return;
  US_CHECK(std::isfinite(edit.turn_deg), "the turn is not finite");
  const Mat3 R = rotation_about_y(edit.turn_deg * kPi / 180);
  const Vec3 centre = motion.poses.front().root;
  for (Pose& pose : motion.poses) {
    pose.root = centre + R * (pose.root - centre);
    pose.local[Pelvis] = R * pose.local[Pelvis];
  }
}

}  // namespace

bool PoseEdits::empty() const {
  return fill.empty() && !go_on && rotate.empty() && !smooth && !raise && !pin && !turn && !loop && !trim &&
         skip.empty() && !tempo;
}

EditedBody EditedBody::from(const Points& rest_vertices, const Joints& rest_joints) {
  return {rest_joints, SupportPoints::from(rest_vertices, rest_joints)};
}

Pose rotated(const std::vector<RotateEdit>& edits, int frame, Pose pose) {
  for (const RotateEdit& edit : edits) {
    check(edit);
    const float amount = falloff_weight(frame, edit.frame, edit.falloff);
    Mat3& R = pose.local[edit.joint];
    if (amount > 0) R = R * rotation_from_axis_angle(amount * edit.axis_angle);
  }
  return pose;
}

Motion apply_poses(const PoseEdits& edits, const Motion& motion, const EditedBody& body, MotionSpace* space) {
  check(motion);
  Motion result = motion;
  std::vector<FillEdit> fills = edits.fill;
  const auto not_there = [&](const FillEdit& one) { return one.last >= ssize(result.poses); };
  fills.erase(std::remove_if(fills.begin(), fills.end(), not_there), fills.end());
  fill_frames(fills, body.rest, space, result);
  if (edits.go_on && !result.poses.empty()) go_on(*edits.go_on, body.rest, space, result);
  rotate(edits.rotate, body.rest, result);
  if (edits.smooth) smooth(*edits.smooth, result);
  if (edits.raise)
    for (Pose& pose : result.poses) pose.root.y() += edits.raise->offset_m;
  if (edits.pin) pin_feet(*edits.pin, result, body);
  if (edits.turn) turn(*edits.turn, result);
  if (edits.loop && edits.loop->last < ssize(result.poses)) close_loop(*edits.loop, body.rest, space, result);
  return result;
}

std::vector<int> kept_frames(const PoseEdits& edits, int count) {
  int first = 0, last = count - 1;
  if (edits.trim) {
    first = std::max(first, edits.trim->first);
    last = std::min(last, edits.trim->last);
    US_CHECK(count == 0 || first <= last, "the trim ", edits.trim->first, " to ", edits.trim->last,
             " leaves nothing of ", count, " frames");
  }
  std::vector<int> kept;
  for (int t = first; t <= last; ++t)
    if (edits.skip.count(t) == 0) kept.push_back(t);
  return kept;
}

bool need_space(const PoseEdits& edits) {
  return need_space(edits.fill) || (edits.go_on && edits.go_on->learned > 0) ||
         (edits.loop && edits.loop->learned > 0);
}

EditCost edit_cost(const Motion& before, const Motion& after, const Joints& rest) {
  US_CHECK(before.poses.size() <= after.poses.size(), "motions of ", before.poses.size(), " and ",
           after.poses.size(), " frames cannot be compared");
  const auto x = joints_over_time(before, rest);
  auto y = joints_over_time(after, rest);
  y.resize(x.size());
  EditCost cost;
  cost.acceleration_before = mean_acceleration(x, before.fps);
  cost.acceleration_after = mean_acceleration(y, after.fps);
  for (size_t t = 0; t < x.size(); ++t) {
    const Eigen::VectorXf moved = (y[t] - x[t]).rowwise().norm();
    cost.mean_displacement_m += static_cast<double>(moved.mean()) / static_cast<double>(x.size());
    cost.max_displacement_m = std::max(cost.max_displacement_m, static_cast<double>(moved.maxCoeff()));
  }
  return cost;
}

}  // namespace understudy
