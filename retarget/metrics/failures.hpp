// What goes wrong in a frame, by name: classes of failures with plain definitions.
#pragma once

#include <array>
#include <vector>

#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {

enum Failure : int {
  SidesSwapped,    ///< exchanging left and right of both arms or both legs lowers the error of what was seen
  HeadingFlipped,  ///< the hip line seen points more than 90 degrees away from the true one
  LimbLost,     ///< an elbow, wrist, knee, ankle or foot seen lies more than 15 cm off, its sides not swapped
  Jolt,         ///< a joint's acceleration is off by more than 5 cm/frame^2 at 30 frames/s
  FootSlides,   ///< a foot that truly stands (under 0.1 m/s) moves at over 0.3 m/s
  BoneTwisted,  ///< a limb's bone is turned more than 45 degrees about itself while it points within 30
                ///< degrees
  kFailureCount
};
/// Keys in reports.
extern const std::array<const char*, kFailureCount> kFailureNames;
using FrameFailures = std::array<bool, kFailureCount>;

/// A sequence beside its truth. Pairs of which either is empty are not evaluated; the others are equally
/// long.
struct EvaluatedSequence {
  const JointSequence &seen, &seen_truth;                    ///< joints of the source
  const JointSequence &performed, &performed_truth;          ///< joints of the target
  const std::vector<Rotations>&rotations, &rotations_truth;  ///< local, of the target
  double fps = 30;
};

/// Frame by frame; Jolt and FootSlides look at the frames just before, Jolt at the target, else at what was
/// seen.
std::vector<FrameFailures> failures_of(const EvaluatedSequence& sequence);

}  // namespace understudy
