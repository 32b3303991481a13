#include "retarget/skeleton/curve_doubt.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"

namespace understudy {
namespace {

constexpr float kUsualSpeed = 0.5f, kStill = 0.1f, kEven = 0.005f;  // m/s
constexpr float kOfSpeed = 0.2f;

/// The frames of which all is known.
std::vector<int> whole_frames(const std::vector<KnownParts>& known) {
  std::vector<int> frames;
  for (int t = 0; t < ssize(known); ++t)
    if (known[t] == all_parts(true)) frames.push_back(t);
  return frames;
}

/// From each of these frames to the next, m/s.
std::vector<Joints> velocities_between(const std::vector<int>& frames, const Motion& motion,
                                       const Joints& rest) {
  const auto joints_at = [&](int i) { return forward_kinematics(rest, motion.poses[frames[i]]).joints; };
  std::vector<Joints> velocities;
  Joints here = joints_at(0);
  for (int i = 0; i + 1 < ssize(frames); ++i) {
    const Joints next = joints_at(i + 1);
    velocities.push_back((next - here) * (motion.fps / static_cast<float>(frames[i + 1] - frames[i])));
    here = next;
  }
  return velocities;
}

float mean_length(const Joints& ways) {
  return ways.rowwise().norm().mean();
}

/// Of numbers one after the other.
struct Mean {
  float sum = 0;
  int count = 0;
  void add(float number) { sum += number, ++count; }
  float value() const { return sum / static_cast<float>(count); }
};

}  // namespace

float DoubtLaw::metres(float seconds, const JointsGoing& going) const {
  const float v = follows ? going.change + kOfSpeed * going.speed + kEven : going.speed + kStill;
  return size * std::pow(seconds, by_time) * std::pow(v, by_speed);
}

std::vector<JointsGoing> joints_going(const std::vector<KnownParts>& known, const Motion& motion,
                                      const Joints& rest) {
  const std::vector<int> frames = whole_frames(known);
  std::vector<JointsGoing> going(known.size(), {kUsualSpeed, kUsualSpeed});
  if (frames.size() < 2) return going;
  const std::vector<Joints> velocities = velocities_between(frames, motion, rest);
  for (int t = 0; t < ssize(going); ++t) {
    const auto after = std::upper_bound(frames.begin(), frames.end(), t) - frames.begin();
    const auto first = std::max<std::ptrdiff_t>(0, after - 2), last = std::min(after, ssize(velocities) - 1);
    Mean speed, change;
    for (auto i = first; i <= last; ++i) speed.add(mean_length(velocities[i]));
    for (auto i = first; i < last; ++i) change.add(mean_length(velocities[i + 1] - velocities[i]));
    const bool between = after > 0 && after < ssize(frames) && first < last;
    going[t] = {speed.value(), between ? change.value() : speed.value()};
  }
  return going;
}

std::vector<float> doubt_of(const DoubtLaw& law, const std::vector<KnownParts>& known, const Motion& motion,
                            const Joints& rest) {
  const std::vector<KnownDistance> distances = known_distances(known);
  const std::vector<JointsGoing> going = joints_going(known, motion, rest);
  std::vector<float> doubt(known.size(), 0.0f);
  for (size_t t = 0; t < known.size(); ++t)
    for (size_t part = 0; part < kPartCount; ++part) {
      if (known[t][part]) continue;
      const auto& [since, until] = distances[t][part];
      const float frames = law.since_last && since < kFarFrames ? since : std::min(since, until);
      doubt[t] += law.metres(frames / motion.fps, going[t]) / kPartCount;
    }
  return doubt;
}

std::vector<float> curve_doubt(const std::vector<KnownParts>& known, const Motion& motion,
                               const Joints& rest) {
  return doubt_of(kCurveDoubt, known, motion, rest);
}

}  // namespace understudy
