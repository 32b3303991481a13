#include "retarget/metrics/failures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {

const std::array<const char*, kFailureCount> kFailureNames = {
    "sides_swapped", "heading_flipped", "limb_lost", "jolt", "foot_slides", "bone_twisted"};

namespace {

constexpr float kLost = 0.15f, kJolt = 0.05f;           // metres, metres a frame squared
constexpr double kStands = 0.1, kSlides = 0.3;          // m/s
constexpr float kTwist = kPi / 4, kPointing = kPi / 6;  // radians

bool both(size_t predicted, size_t truth) {
  US_CHECK(predicted == 0 || truth == 0 || predicted == truth, predicted, " frames cannot be evaluated by ",
           truth);
  return predicted > 0 && truth > 0;
}

bool limb_lost(const Joints& seen, const Joints& truth) {
  for (const int j : {LeftElbow, RightElbow, LeftWrist, RightWrist, LeftKnee, RightKnee, LeftAnkle,
                      RightAnkle, LeftFoot, RightFoot})
    if ((seen.row(j) - truth.row(j)).norm() > kLost) return true;
  return false;
}

/// The last three frames' joints jerk away from the truth's.
bool jolt(const JointSequence& p, const JointSequence& q, size_t t, double fps) {
  if (t < 2) return false;
  const auto second = [t](const JointSequence& x) { return Joints(x[t] - 2 * x[t - 1] + x[t - 2]); };
  const float to_30 = static_cast<float>(fps * fps / 900);
  return to_30 * (second(p) - second(q)).rowwise().norm().maxCoeff() > kJolt;
}

bool foot_slides(const JointSequence& p, const JointSequence& q, size_t t, double fps) {
  if (t < 1) return false;
  for (const int foot : {LeftFoot, RightFoot}) {
    const Vec3 step = p[t].row(foot) - p[t - 1].row(foot);
    const double true_speed = (q[t].row(foot) - q[t - 1].row(foot)).norm() * fps;
    if (true_speed < kStands && std::hypot(step.x(), step.z()) * fps > kSlides) return true;
  }
  return false;
}

bool bone_twisted(const Rotations& predicted, const Rotations& truth) {
  const Rotations p = global_rotations(predicted), q = global_rotations(truth);
  for (const int j :
       {LeftHip, RightHip, LeftKnee, RightKnee, LeftShoulder, RightShoulder, LeftElbow, RightElbow}) {
    const Vec3 bone = j < LeftCollar ? Vec3(0, -1, 0) : Vec3(1, 0, 0);  // along it in T-pose, either way
    const Mat3 off = q[j].transpose() * p[j];
    if (std::acos(std::clamp(bone.dot(off * bone), -1.f, 1.f)) > kPointing) continue;
    const Eigen::Quaternionf turn(off);
    const float half = std::atan2(turn.vec().dot(bone), turn.w());
    if (std::abs(std::remainder(2 * half, 2 * kPi)) > kTwist) return true;
  }
  return false;
}

}  // namespace

std::vector<FrameFailures> failures_of(const EvaluatedSequence& s) {
  const bool seen = both(s.seen.size(), s.seen_truth.size());
  const bool performed = both(s.performed.size(), s.performed_truth.size());
  const bool turned = both(s.rotations.size(), s.rotations_truth.size());
  std::vector<FrameFailures> all(std::max({s.seen.size(), s.performed.size(), s.rotations.size()}));
  for (size_t t = 0; t < all.size(); ++t) {
    FrameFailures& frame = all[t];
    frame.fill(false);
    if (seen) {
      frame[SidesSwapped] = swap_rate({s.seen[t]}, {s.seen_truth[t]}) > 0;
      frame[HeadingFlipped] = flip_rate({s.seen[t]}, {s.seen_truth[t]}) > 0;
      frame[LimbLost] = !frame[SidesSwapped] && limb_lost(s.seen[t], s.seen_truth[t]);
    }
    if (performed) {
      frame[Jolt] = jolt(s.performed, s.performed_truth, t, s.fps);
      frame[FootSlides] = foot_slides(s.performed, s.performed_truth, t, s.fps);
    } else if (seen) {
      frame[Jolt] = jolt(s.seen, s.seen_truth, t, s.fps);
    }
    if (turned) frame[BoneTwisted] = bone_twisted(s.rotations[t], s.rotations_truth[t]);
  }
  return all;
}

}  // namespace understudy
