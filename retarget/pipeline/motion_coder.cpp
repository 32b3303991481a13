#include "retarget/pipeline/motion_coder.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {

Pose pose_at(const TimedPoses& movement, float seconds) {
  const auto& times = movement.seconds;
  US_CHECK(!movement.poses.empty() && movement.poses.size() == times.size(), "a movement without poses");
  const auto next = std::upper_bound(times.begin(), times.end(), seconds);
  if (next == times.begin()) return movement.poses.front();
  if (next == times.end()) return movement.poses.back();
  const size_t after = static_cast<size_t>(next - times.begin());
  const float share = (seconds - times[after - 1]) / (times[after] - times[after - 1]);
  return between(movement.poses[after - 1], movement.poses[after], share);
}

}  // namespace understudy
