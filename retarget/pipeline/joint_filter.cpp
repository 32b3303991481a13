#include "retarget/pipeline/joint_filter.hpp"

#include <algorithm>
#include <vector>

#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {

namespace {

using SwapGroup = std::vector<int>;  // joints of the left side; kMirror has the other

const std::array<SwapGroup, 4>& swap_groups() {
  static const std::array<SwapGroup, 4> groups = {
      {{LeftHip, LeftKnee, LeftAnkle, LeftFoot, LeftCollar, LeftShoulder, LeftElbow, LeftWrist},
       {LeftHip, LeftKnee, LeftAnkle, LeftFoot},
       {LeftKnee, LeftAnkle, LeftFoot},
       {LeftElbow, LeftWrist}}};
  return groups;
}

}  // namespace

JointFilter::JointFilter(const JointFilterOptions& options) : options_(options) {
  reset();
}

void JointFilter::reset() {
  tracks_.fill(Track{});
  lengths_.fill(RunningMedian(std::max(1, options_.length_window)));
  turning_ = false;
  frames_ = swaps_in_a_row_ = 0;
  repaired_ = false;
}

void JointFilter::repair_swaps(Extraction& frame) {
  if (frames_ == 0) return;
  const Joints predicted = frames_ > 1 ? Joints(last_ + 0.5f * (last_ - before_last_)) : last_;
  for (const SwapGroup& group : swap_groups()) {
    float kept = 0, exchanged = 0, confidence = 0;
    for (const int j : group) {
      const int m = kMirror[j];
      const auto cost = [&](int a, int b) { return (frame.joints.row(a) - predicted.row(b)).squaredNorm(); };
      kept += cost(j, j) + cost(m, m);
      exchanged += cost(m, j) + cost(j, m);
      confidence += 0.5f * (frame.confidence[j] + frame.confidence[m]);
    }
    const float n = static_cast<float>(group.size());
    // Far nearer exchanged, and far off as it is: more than 8 cm a joint.
    const bool nearer = exchanged < 0.4f * kept && kept > 2 * n * 0.08f * 0.08f;
    if (!nearer || confidence > options_.swap_confidence * n || swaps_in_a_row_ >= options_.swap_patience)
      continue;
    for (const int j : group) {
      frame.joints.row(j).swap(frame.joints.row(kMirror[j]));
      std::swap(frame.confidence[j], frame.confidence[kMirror[j]]);
    }
    repaired_ = true;
  }
  swaps_in_a_row_ = repaired_ ? swaps_in_a_row_ + 1 : 0;
  if (repaired_) frame.global.reset();
}

/// Covariance of a constant velocity disturbed by a random acceleration held over dt.
void JointFilter::Covariance::predict(float dt, float acceleration) {
  const float q = acceleration * acceleration;
  pp += 2 * dt * pv + dt * dt * vv + 0.25f * dt * dt * dt * dt * q;
  pv += dt * vv + 0.5f * dt * dt * dt * q;
  vv += dt * dt * q;
}

std::array<float, 2> JointFilter::Covariance::correct(float innovation, float noise) {
  // An innovation beyond four deviations is a real jump that the model does not know: follow it, do not lag.
  const float expected = 3 * (pp + noise * noise);
  const float excess = innovation / (16 * expected);
  if (excess > 1) {
    pp *= excess;
    vv *= excess;
    pv *= excess;
  }
  const float s = pp + noise * noise;
  const float kp = pp / s, kv = pv / s;
  vv -= kv * pv;
  pv *= 1 - kp;
  pp *= 1 - kp;
  return {kp, kv};
}

float JointFilter::noise(float confidence, float sure, float weak) const {
  return weak + std::clamp(confidence, 0.0f, 1.0f) * (sure - weak);
}

void JointFilter::smooth(Extraction& frame, float dt) {
  const auto measured = [&](int j) -> Vec3 {
    const Vec3 joint = frame.joints.row(j).transpose(), pelvis = frame.joints.row(Pelvis).transpose();
    return j == Pelvis ? joint : Vec3(joint - pelvis);
  };
  if (frames_ == 0) {
    const float pp = options_.noise_m * options_.noise_m;
    for (int j = 0; j < kJointCount; ++j) tracks_[j] = {measured(j), Vec3::Zero(), {pp, 0, /*m/s*/ 1.0f}};
    return;
  }
  for (int j = kJointCount - 1; j >= 0; --j) {  // the pelvis last: the others are measured from it
    Track& t = tracks_[j];
    t.position += dt * t.velocity;
    t.covariance.predict(dt, j == Pelvis ? options_.root_acceleration : options_.acceleration);
    const Vec3 innovation = measured(j) - t.position;
    const auto [kp, kv] = t.covariance.correct(
        innovation.squaredNorm(), noise(frame.confidence[j], options_.noise_m, options_.weak_noise_m));
    t.position += kp * innovation;
    t.velocity += kv * innovation;
  }
  for (int j = 0; j < kJointCount; ++j) {
    const Vec3 base = j == Pelvis ? Vec3(Vec3::Zero()) : tracks_[Pelvis].position;
    frame.joints.row(j) = (base + tracks_[j].position).transpose();
  }
}

void JointFilter::smooth_turns(Extraction& frame, float dt) {
  if (!frame.global) {
    turning_ = false;
    return;
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    Turn& t = turns_[j];
    Mat3& seen = (*frame.global)[j];
    if (!turning_) {
      const float pp = options_.turn_noise * options_.turn_noise;
      t = {seen, Vec3::Zero(), {pp, 0, /*(rad/s)^2*/ 4.0f}};
      continue;
    }
    const Mat3 expected = rotation_from_axis_angle(dt * t.velocity) * t.rotation;
    t.covariance.predict(dt, options_.turn_acceleration);
    const Vec3 innovation = rotation_to_axis_angle(seen * expected.transpose());
    const float deviation = noise(frame.confidence[j], options_.turn_noise, options_.weak_turn_noise);
    const auto [kp, kv] = t.covariance.correct(innovation.squaredNorm(), deviation);
    // Products of rotations drift from being one.
    t.rotation = Eigen::Quaternionf(Mat3(rotation_from_axis_angle(kp * innovation) * expected))
                     .normalized()
                     .toRotationMatrix();
    t.velocity += kv * innovation;
    seen = t.rotation;
  }
  turning_ = true;
}

Eigen::Array<float, kJointCount, 1> JointFilter::lengths() const {
  Eigen::Array<float, kJointCount, 1> lengths;
  for (int j = 0; j < kJointCount; ++j)
    lengths[j] = 0.5f * (lengths_[j].value() + lengths_[kMirror[j]].value());
  return lengths;
}

void JointFilter::fix_lengths(Extraction& frame) {
  const auto wanted = lengths();
  // sure joints move less
  const Eigen::Array<float, kJointCount, 1> give = 1.05f - frame.confidence.max(0.0f).min(1.0f);
  for (int round = 0; round < 6; ++round) {
    for (int j = 1; j < kJointCount; ++j) {
      const int p = kParents[j];
      const Vec3 bone = (frame.joints.row(j) - frame.joints.row(p)).transpose();
      const float length = bone.norm();
      if (length < 1e-6f) continue;
      const Vec3 change = bone * ((wanted[j] - length) / length);
      frame.joints.row(j) += (give[j] / (give[j] + give[p]) * change).transpose();
      frame.joints.row(p) -= (give[p] / (give[j] + give[p]) * change).transpose();
    }
  }
}

Extraction JointFilter::push(const Extraction& raw, float dt) {
  Extraction frame = raw;
  repaired_ = false;
  if (options_.repair_swaps && !raw.exact) repair_swaps(frame);
  const auto seen = bone_lengths(frame.joints);
  for (int j = 1; j < kJointCount; ++j) lengths_[j].push(seen[j]);
  before_last_ = last_;
  last_ = frame.joints;
  if (options_.smooth && !raw.exact) {
    smooth(frame, dt);
    smooth_turns(frame, dt);
  }
  if (options_.fix_lengths && !raw.exact) fix_lengths(frame);
  ++frames_;
  return frame;
}

}  // namespace understudy
