#include "retarget/skeleton/curve_doubt.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"

namespace understudy {
namespace {

constexpr float kStill = 0.3f;      // m/s, of a body that stands: it, too, may have moved
constexpr float kMostShare = 0.8f;  // of the way that a body goes meanwhile
constexpr float kHalfway_s = 0.6f;  // from the nearest known frame, at which half of that is doubted

/// Mean speed of the joints over the known frames and the gap beside a frame, m/s.
std::vector<float> speeds(const Motion& curve, const Joints& rest) {
  std::vector<float> speeds(curve.poses.size(), 0.0f);
  Joints before;
  for (int t = 0; t < ssize(curve.poses); ++t) {
    const Joints joints = forward_kinematics(rest, curve.poses[t]).joints;
    if (t > 0) speeds[t] = (joints - before).rowwise().norm().mean() * curve.fps;
    before = joints;
  }
  return speeds;
}

}  // namespace

std::vector<float> curve_doubt(const std::vector<KnownParts>& known, const Motion& curve,
                               const Joints& rest) {
  const std::vector<KnownDistance> distances = known_distances(known);
  const std::vector<float> speed = speeds(curve, rest);
  std::vector<float> doubt(known.size(), 0.0f);
  for (size_t t = 0; t < known.size(); ++t) {
    float nearest = 0;
    for (const auto& part : distances[t]) nearest = std::max(nearest, std::min(part[0], part[1]));
    const float away_s = nearest / curve.fps;
    const float share = kMostShare * away_s / (away_s + kHalfway_s);
    doubt[t] = share * away_s * (kStill + speed[t]);
  }
  return doubt;
}

}  // namespace understudy
