#include "retarget/motion_space/blend.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/knot_coder.hpp"
#include "retarget/motion_space/motion_window.hpp"
#include "retarget/motion_space/seam.hpp"
#include "retarget/skeleton/foot_hold.hpp"
#include "retarget/skeleton/pose_curve.hpp"
#include "retarget/skeleton/stances.hpp"

namespace understudy {
namespace {

constexpr int kLastSample = Blend::kSamples - 1;

float share_of_sample(int k) {
  return static_cast<float>(k) / kLastSample;
}

/// Of decoded poses, which are evenly many and not evenly timed: number k of kSamples, and its time.
struct DecodedSample {
  Pose pose;
  float seconds = 0;
};
DecodedSample decoded_sample(const TimedPoses& movement, int k) {
  const int last = ssize(movement.poses) - 1;
  const float at = share_of_sample(k) * static_cast<float>(last);
  const int before = std::min(static_cast<int>(at), last), after = std::min(before + 1, last);
  const float share = at - static_cast<float>(before);
  const float from = movement.seconds[before], to = movement.seconds[after];
  return {between(movement.poses[before], movement.poses[after], share), from + share * (to - from)};
}

std::vector<Joints> joints_of(const Joints& rest, const std::vector<Pose>& poses) {
  std::vector<Joints> joints;
  joints.reserve(poses.size());
  for (const Pose& pose : poses) joints.push_back(forward_kinematics(rest, pose).joints);
  return joints;
}

/// The mean distance of two bodies' joints, both about the pelvis.
float apart(const Joints& a, const Joints& b) {
  const Joints about_a = a.rowwise() - a.row(Pelvis), about_b = b.rowwise() - b.row(Pelvis);
  return (about_a - about_b).rowwise().norm().mean();
}

std::vector<float> normalised(const std::vector<float>& weights, size_t count) {
  US_CHECK(weights.size() == count, "a blend of ", count, " needs ", count, " weights, not ", weights.size());
  float sum = 0;
  for (const float w : weights) {
    US_CHECK(std::isfinite(w) && w >= 0, "a weight of a blend is 0 or more, not ", w);
    sum += w;
  }
  US_CHECK(sum > 0 && std::isfinite(sum), "the weights of a blend are all 0");
  std::vector<float> shares = weights;
  for (float& w : shares) w /= sum;
  return shares;
}

/// Numbers that rise, from 0 to 1: each at least a tenth of an even step behind the one before.
void make_rise(std::vector<float>& share) {
  constexpr float kLeastStep = 0.1f / kLastSample;
  const float first = share.front();
  for (float& one : share) one -= first;
  for (size_t k = 1; k < share.size(); ++k) share[k] = std::max(share[k], share[k - 1] + kLeastStep);
  const float last = share.back();
  for (float& one : share) one /= last;
}

Outlook on_the_ground(const Pose& pose) {
  Outlook from = Outlook::of(pose);
  from.place.y() = 0;
  return from;
}

}  // namespace

Blend::Blend(MotionCoder& coder, std::vector<BlendInput> inputs) : coder_(coder), inputs_(std::move(inputs)) {
  US_CHECK(inputs_.size() >= kFewest && inputs_.size() <= kMost, "a blend is made of ", kFewest, " to ",
           kMost, " movements, not of ", inputs_.size());
  std::vector<std::vector<Joints>> joints;
  for (const BlendInput& input : inputs_) {
    corners_.push_back(corner_of(input));
    joints.push_back(joints_of(input.rest, corners_.back().captured));
  }
  for (size_t i = 0; i < inputs_.size(); ++i)
    for (size_t j = i + 1; j < inputs_.size(); ++j) {
      auto& pair = apart_m_.emplace_back();
      for (int k = 0; k < kSamples; ++k) pair.push_back(apart(joints[i][k], joints[j][k]));
    }
}

Blend::Corner Blend::corner_of(const BlendInput& input) const {
  Corner corner;
  corner.code = coder_.encode(input.movement, input.rest).mean;
  corner.captured = sampled_evenly(input.movement, kSamples);
  corner.duration = input.movement.duration() - input.movement.seconds.front();
  corner.leg = leg_length(input.rest);
  const TimedPoses decoded = coder_.decode(corner.code, input.rest);
  const std::vector<Joints> joints = joints_of(input.rest, corner.captured);
  for (int k = 0; k < kSamples; ++k) {
    const DecodedSample sample = decoded_sample(decoded, k);
    corner.decoded.push_back(sample.pose);
    corner.share.push_back(sample.seconds / std::max(decoded.duration(), 1e-3f));
    corner.error_m.push_back(apart(joints[k], forward_kinematics(input.rest, sample.pose).joints));
  }
  corner.standing = stances(joints, corner.duration / kLastSample, corner.leg);
  return corner;
}

/// By what the inputs differ from their decoded forms, as far as each of them counts.
Pose Blend::bent(Pose decoded, int k, const std::vector<float>& weights, float leg) const {
  for (int j = 0; j < kJointCount; ++j) {
    Vec3 turn = Vec3::Zero();
    for (size_t i = 0; i < corners_.size(); ++i)
      turn += weights[i] * rotation_to_axis_angle(corners_[i].decoded[k].local[j].transpose() *
                                                  corners_[i].captured[k].local[j]);
    decoded.local[j] = decoded.local[j] * rotation_from_axis_angle(turn);
  }
  for (size_t i = 0; i < corners_.size(); ++i)
    decoded.root +=
        weights[i] * leg / corners_[i].leg * (corners_[i].captured[k].root - corners_[i].decoded[k].root);
  return decoded;
}

float Blend::doubt_at(int k, const std::vector<float>& weights) const {
  float spread = 1, error = 0, between_m = 0;
  size_t pair = 0;
  for (size_t i = 0; i < corners_.size(); ++i) {
    spread -= weights[i] * weights[i];
    error += weights[i] * corners_[i].error_m[k];
    for (size_t j = i + 1; j < corners_.size(); ++j)
      between_m += weights[i] * weights[j] * apart_m_[pair++][k];
  }
  return std::max(kLeastDoubt_m, 2 * spread * error + between_m);
}

Blended Blend::at(const std::vector<float>& weights) const {
  const std::vector<float> w = normalised(weights, size());
  Blended made;
  std::vector<float> code(coder_.size(), 0);
  float duration = 0;
  for (size_t i = 0; i < size(); ++i) {
    made.rest += w[i] * inputs_[i].rest;
    duration += w[i] * corners_[i].duration;
    for (size_t n = 0; n < code.size(); ++n) code[n] += w[i] * corners_[i].code[n];
  }
  const TimedPoses decoded = coder_.decode(code, made.rest);
  const float leg = leg_length(made.rest);
  std::vector<float> share;
  for (int k = 0; k < kSamples; ++k) {
    const DecodedSample sample = decoded_sample(decoded, k);
    made.movement.poses.push_back(bent(sample.pose, k, w, leg));
    share.push_back(sample.seconds / std::max(decoded.duration(), 1e-3f));
    made.doubt_m.push_back(doubt_at(k, w));
    Standing& standing = made.standing.emplace_back();
    float stands[2] = {0, 0};
    for (size_t i = 0; i < size(); ++i) {
      share[k] += w[i] * (share_of_sample(k) - corners_[i].share[k]);
      for (int side = 0; side < 2; ++side) stands[side] += corners_[i].standing[k][side] ? w[i] : 0;
    }
    for (int side = 0; side < 2; ++side) standing[side] = stands[side] > 0.5f;
  }
  made.decoded_s = decoded.duration();
  make_rise(share);
  for (const float one : share) made.movement.seconds.push_back(one * duration);
  return made;
}

float Blend::distance(size_t i, size_t j) const {
  if (i > j) std::swap(i, j);
  size_t pair = 0;
  for (size_t a = 0; a < size(); ++a)
    for (size_t b = a + 1; b < size(); ++b, ++pair) {
      if (a != i || b != j) continue;
      float sum = 0;
      for (const float metres : apart_m_[pair]) sum += metres;
      return sum / static_cast<float>(apart_m_[pair].size());
    }
  return 0;
}

std::vector<std::vector<float>> weights_along(size_t count, int steps) {
  US_CHECK(steps >= 2, "a line of blends has 2 steps or more, not ", steps);
  std::vector<std::vector<float>> weights;
  for (int i = 0; i < steps; ++i) {
    const float at = static_cast<float>(i) * static_cast<float>(count - 1) / static_cast<float>(steps - 1);
    const size_t corner = std::min(static_cast<size_t>(at), count - 2);
    auto& one = weights.emplace_back(count, 0.0f);
    one[corner + 1] = at - static_cast<float>(corner);
    one[corner] = 1 - one[corner + 1];
  }
  return weights;
}

Motion played(const Blended& blended, float fps, int cycles) {
  US_CHECK(fps >= 1 && fps <= 1000, "a frame rate is 1 to 1000, not ", fps);
  US_CHECK(cycles >= 1 && cycles <= 1000, "a movement is played 1 to 1000 times, not ", cycles);
  TimedPoses cycle = blended.movement;
  if (cycles > 1) close_seam(cycle.poses);
  const Outlook begin = on_the_ground(cycle.poses.front()), end = on_the_ground(cycle.poses.back());
  const float duration = cycle.duration();
  Motion motion;
  motion.fps = fps;
  const auto count =
      static_cast<int64_t>(std::floor(duration * static_cast<float>(cycles) * fps + 1e-3f)) + 1;
  Outlook from;
  int turn = 0;
  for (int64_t t = 0; t < count; ++t) {
    const float seconds = static_cast<float>(t) / fps;
    for (; turn + 1 < cycles && seconds >= static_cast<float>(turn + 1) * duration; ++turn)
      from = {from.place + from.heading * (end.place - end.heading * begin.heading.transpose() * begin.place),
              from.heading * end.heading * begin.heading.transpose()};
    const float at = seconds - static_cast<float>(turn) * duration;
    motion.poses.push_back(from.placed(pose_at(cycle, at)));
    const auto next = std::upper_bound(cycle.seconds.begin(), cycle.seconds.end(), at);
    const ptrdiff_t k = std::max<ptrdiff_t>(0, next - cycle.seconds.begin() - 1);
    motion.standing.push_back(blended.standing[k]);
    motion.doubt_m.push_back(blended.doubt_m[k]);
  }
  hold_standing(blended.rest, 0, static_cast<int>(count) - 1, motion);
  return motion;
}

float left_lead(const TimedPoses& movement) {
  constexpr int kLooks = 32;
  const std::vector<Pose> poses = sampled_evenly(movement, kLooks + 1);
  float lead = 0;
  for (int k = 0; k < kLooks; ++k) {
    const auto forward = [&](int hip) {
      return std::asin(std::clamp(-poses[k].local[hip](2, 1), -1.0f, 1.0f));
    };
    lead += 2.0f / kLooks * std::sin(2 * kPi * static_cast<float>(k) / kLooks) *
            (forward(LeftHip) - forward(RightHip));
  }
  return std::abs(lead) < kLeastLead ? 0 : lead;
}

TimedPoses mirrored(TimedPoses movement) {
  for (Pose& pose : movement.poses) pose = mirrored(pose);
  return movement;
}

Joints mirrored(const Joints& rest) {
  Joints mirror;
  for (int j = 0; j < kJointCount; ++j) mirror.row(j) = rest.row(kMirror[j]);
  mirror.col(0) *= -1;
  return mirror;
}

}  // namespace understudy
