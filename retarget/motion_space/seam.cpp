#include "retarget/motion_space/seam.hpp"

#include <array>

#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/motion_window.hpp"

namespace understudy {

void close_seam(std::vector<Pose>& poses) {
  const Pose first = Outlook::of(poses.front()).seen(poses.front()),
             last = Outlook::of(poses.back()).seen(poses.back());
  std::array<Vec3, kJointCount> missing;
  for (int j = 0; j < kJointCount; ++j)
    missing[j] = rotation_to_axis_angle(first.local[j].transpose() * last.local[j]);
  const float rise = poses.back().root.y() - poses.front().root.y();
  for (int k = 0; k < ssize(poses); ++k) {
    const float share = 0.5f - static_cast<float>(k) / static_cast<float>(ssize(poses) - 1);
    for (int j = 0; j < kJointCount; ++j)
      poses[k].local[j] = poses[k].local[j] * rotation_from_axis_angle(share * missing[j]);
    poses[k].root.y() += share * rise;
  }
}

}  // namespace understudy
