// A window of motion as the networks of the motion space see it: about its own place and heading, with how
// far each frame is from what is known.
#pragma once

#include <array>
#include <vector>

#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {

/// Where a window is looked at from: the place and heading of one of its poses. What is seen from there is
/// the same wherever a motion goes and whichever way.
struct Outlook {
  Vec3 place = Vec3::Zero();  ///< metres
  Mat3 heading = Mat3::Identity();

  static Outlook of(const Pose& pose);
  Pose seen(Pose pose) const;
  Pose back(Pose pose) const;
};

constexpr float kFarFrames = 120;  ///< as far as a known frame is told apart from none

/// Of each frame and part the frames since the last known one and until the next, at most kFarFrames; 0, 0
/// where the part is known.
using KnownDistance = std::array<std::array<float, 2>, kPartCount>;
std::vector<KnownDistance> known_distances(const std::vector<KnownParts>& known);

/// The frame that a window is looked at from: the last that is wholly known before the first that is not, or
/// the first that is wholly known; 0 where none is.
int outlook_frame(const std::vector<KnownParts>& known);

}  // namespace understudy
