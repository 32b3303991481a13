#include "retarget/motion_space/motion_window.hpp"

#include <algorithm>

#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {

Outlook Outlook::of(const Pose& pose) {
  return {pose.root, rotation_about_y(heading_of(pose.local[Pelvis]))};
}

Pose Outlook::seen(Pose pose) const {
  pose.root = heading.transpose() * (pose.root - place);
  pose.local[Pelvis] = heading.transpose() * pose.local[Pelvis];
  return pose;
}

Pose Outlook::back(Pose pose) const {
  pose.root = place + heading * pose.root;
  pose.local[Pelvis] = heading * pose.local[Pelvis];
  return pose;
}

std::vector<KnownDistance> known_distances(const std::vector<KnownParts>& known) {
  const int count = ssize(known);
  std::vector<KnownDistance> distances(known.size());
  for (size_t part = 0; part < kPartCount; ++part) {
    float since = kFarFrames, until = kFarFrames;
    for (int t = 0; t < count; ++t) {
      since = known[t][part] ? 0 : std::min(since + 1, kFarFrames);
      distances[t][part][0] = since;
    }
    for (int t = count - 1; t >= 0; --t) {
      until = known[t][part] ? 0 : std::min(until + 1, kFarFrames);
      distances[t][part][1] = until;
    }
  }
  return distances;
}

int outlook_frame(const std::vector<KnownParts>& known) {
  int last = -1;
  for (int t = 0; t < ssize(known); ++t) {
    const bool whole = known[t] == all_parts(true);
    if (!whole && last >= 0) return last;
    if (whole) last = t;
  }
  return std::max(0, last);
}

}  // namespace understudy
