// How what looks at a pose as a whole begins: its points are there, and finite.
#pragma once

#include <string>

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// A pose with its middles (neck, mid-hip), and the box around the paper's 15 points.
struct SeenPoints {
  FlatPose pose;
  FlatBox box;
};
/// Throws Error where fewer than `least` of the 15 are seen ("a pose of 1 points " + `otherwise`), or any of
/// them is not finite.
SeenPoints seen_points(const FlatPose& seen, int least, const std::string& otherwise);

}  // namespace understudy
