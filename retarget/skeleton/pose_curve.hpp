// Smooth curves through what is known of a motion: cubic Hermite curves, part by part.
#pragma once

#include <array>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// `share` of the way from one pose to another: rotations slerped, the root on a straight line. 0 is `a`, 1
/// is `b` to the bit.
Pose between(const Pose& a, const Pose& b, float share);

/// The parts of a pose that can be known each by itself: a rotation for each joint, and last the root's
/// place.
constexpr int kRootPart = kJointCount, kPartCount = kJointCount + 1;
using KnownParts = std::array<bool, kPartCount>;

constexpr KnownParts all_parts(bool known) {
  KnownParts parts{};
  for (bool& part : parts) part = known;
  return parts;
}

constexpr float kFarFrames = 120;  ///< as far as a known frame is told apart from none

/// Of each frame and part the frames since the last known one and until the next, at most kFarFrames; 0, 0
/// where the part is known.
using KnownDistance = std::array<std::array<float, 2>, kPartCount>;
std::vector<KnownDistance> known_distances(const std::vector<KnownParts>& known);

/// Fills, in frames first .. last, the parts that are not known; what is known stays as it is to the bit.
/// `known` has an entry for each frame of the motion. Between known frames a part follows the cubic Hermite
/// curve through both (rotations by their logarithm, seen from the first), as fast at each end as the known
/// frames around it are. Before the first known frame and after the last it goes on and comes to rest within
/// half a second. A part that no frame knows stays.
void fill_curves(const std::vector<KnownParts>& known, int first, int last, Motion& motion);

}  // namespace understudy
