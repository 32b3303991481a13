#include "retarget/motion_space/curve_bend.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// How far a metre of doubt bends.
struct Bend {
  float later;          ///< samples, by which what comes is taken from later on the curve
  float across;         ///< metres, towards the foot in front
  float hip, shoulder;  ///< radians, forwards on the side of the foot in front and backwards on the other
};

// Chosen on dev: there feet slide and joints shake at most 1.15 times as much as in the best answer.
constexpr std::array<Bend, kCurveBends> kBends = {{{32, 0, -3, 5}, {-32, 0, 3, 0}, {0, -1, -2, 0}}};

constexpr float kMostLater = 0.25f;    // of the gap: more would turn back in time
constexpr float kFeetApart_m = 0.03f;  // from which on one foot is in front

/// 0 where the part is known, 1 in the middle of what is not, or a second away from what is.
float wave(const std::array<float, 2>& distance) {
  const auto [since, until] = distance;
  if (since == 0) return 0;
  if (since < kFarFrames && until < kFarFrames) return std::sin(kPi * since / (since + until));
  return std::sin(0.5f * kPi * std::min(1.0f, std::min(since, until) / kWindowRate));
}

/// Samples from known to known; two seconds where that never ends.
float length_of(const std::array<float, 2>& distance) {
  const auto [since, until] = distance;
  return since < kFarFrames && until < kFarFrames ? since + until : 2 * kWindowRate;
}

/// -1 .. 1: which foot is in front, left or right, where the window is looked at from.
float foot_in_front(const MotionWindow& window) {
  const Pose& pose = window.curve[static_cast<size_t>(outlook_frame(known_of(window)))];
  const Joints joints = forward_kinematics(window.rest, pose).joints;
  return std::tanh((joints(LeftAnkle, 2) - joints(RightAnkle, 2)) / kFeetApart_m);
}

/// The parts that are not known, from `later` samples on.
Pose taken_later(const std::vector<Pose>& curve, int sample, float later, const KnownDistance& distance) {
  const int last = ssize(curve) - 1;
  const float when = std::clamp(static_cast<float>(sample) + later, 0.0f, static_cast<float>(last));
  const int now = static_cast<int>(when);
  const Pose other = between(curve[now], curve[std::min(now + 1, last)], when - static_cast<float>(now));
  Pose pose = curve[sample];
  for (int j = 0; j < kJointCount; ++j)
    if (distance[j][0] != 0) pose.local[j] = other.local[j];
  if (distance[kRootPart][0] != 0) pose.root = other.root;
  return pose;
}

}  // namespace

MotionWindow bent(MotionWindow window, int way, const std::vector<float>& doubt_m) {
  US_CHECK(way >= 1 && way <= kCurveBends, "a curve has ", kCurveBends, " bends, but is to have bend ", way);
  US_CHECK(doubt_m.size() == window.curve.size(), "a curve of ", window.curve.size(), " samples has ",
           doubt_m.size(), " doubts");
  const Bend& bend = kBends[static_cast<size_t>(way - 1)];
  const float front = foot_in_front(window);
  const std::vector<Pose> curve = window.curve;
  for (int i = 0; i < ssize(curve); ++i) {
    const KnownDistance& distance = window.distance[i];
    const auto by = [&](int part) { return doubt_m[i] * wave(distance[part]); };
    const float most = kMostLater * length_of(distance[kRootPart]);
    const float later =
        most > 0 ? most * std::tanh(doubt_m[i] * bend.later / most) * wave(distance[kRootPart]) : 0;
    Pose pose = taken_later(curve, i, later, distance);
    const Mat3 ahead = rotation_about_y(heading_of(pose.local[Pelvis]));
    pose.root += by(kRootPart) * front * bend.across * ahead.col(0);
    for (int side = 0; side < 2; ++side) {
      const float forwards = side == 0 ? front : -front;
      Mat3 &hip = pose.local[LeftHip + side], &shoulder = pose.local[LeftShoulder + side];
      hip = hip * rotation_from_axis_angle({-forwards * bend.hip * by(LeftHip + side), 0, 0});
      shoulder =
          rotation_from_axis_angle({-forwards * bend.shoulder * by(LeftShoulder + side), 0, 0}) * shoulder;
    }
    window.curve[i] = pose;
  }
  return window;
}

}  // namespace understudy
