#include "retarget/skeleton/curve_doubt.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"

namespace understudy {
namespace {

constexpr float kUsualSpeed = 0.5f, kStill = 0.1f;  // m/s

/// The frames of which all is known.
std::vector<int> whole_frames(const std::vector<KnownParts>& known) {
  std::vector<int> frames;
  for (int t = 0; t < ssize(known); ++t)
    if (known[t] == all_parts(true)) frames.push_back(t);
  return frames;
}

}  // namespace

float DoubtLaw::metres(float seconds, float speed) const {
  return size * std::pow(seconds, by_time) * std::pow(speed + kStill, by_speed);
}

std::vector<float> known_speeds(const std::vector<KnownParts>& known, const Motion& motion,
                                const Joints& rest) {
  const std::vector<int> frames = whole_frames(known);
  std::vector<float> speeds(known.size(), kUsualSpeed);
  if (frames.size() < 2) return speeds;
  const auto joints_at = [&](int i) { return forward_kinematics(rest, motion.poses[frames[i]]).joints; };
  std::vector<float> steps;  // from each known frame to the next
  Joints here = joints_at(0);
  for (int i = 0; i + 1 < ssize(frames); ++i) {
    const Joints next = joints_at(i + 1);
    const float seconds = static_cast<float>(frames[i + 1] - frames[i]) / motion.fps;
    steps.push_back((next - here).rowwise().norm().mean() / seconds);
    here = next;
  }
  for (int t = 0; t < ssize(speeds); ++t) {
    const auto after = std::upper_bound(frames.begin(), frames.end(), t) - frames.begin();
    float sum = 0;
    int count = 0;
    for (auto i = after - 2; i <= after; ++i)
      if (i >= 0 && i < ssize(steps)) sum += steps[i], ++count;
    speeds[t] = sum / static_cast<float>(count);
  }
  return speeds;
}

std::vector<float> doubt_of(const DoubtLaw& law, const std::vector<KnownParts>& known, const Motion& motion,
                            const Joints& rest) {
  const std::vector<KnownDistance> distances = known_distances(known);
  const std::vector<float> speeds = known_speeds(known, motion, rest);
  std::vector<float> doubt(known.size(), 0.0f);
  for (size_t t = 0; t < known.size(); ++t)
    for (size_t part = 0; part < kPartCount; ++part) {
      if (known[t][part]) continue;
      const auto& [since, until] = distances[t][part];
      const float frames = law.since_last && since < kFarFrames ? since : std::min(since, until);
      doubt[t] += law.metres(frames / motion.fps, speeds[t]) / kPartCount;
    }
  return doubt;
}

std::vector<float> curve_doubt(const std::vector<KnownParts>& known, const Motion& motion,
                               const Joints& rest) {
  return doubt_of(kCurveDoubt, known, motion, rest);
}

}  // namespace understudy
