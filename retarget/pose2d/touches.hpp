// Hands that touch the body in one picture and touch it in another.
#pragma once

#include "retarget/keypoints/hand_pairs.hpp"
#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// Moves the arms of `result`, which does what `source` does on bones of other lengths (from, to: pixels): a
/// wrist nearer to a point (kHandPairs) than 0.04 of the stature is as near to it again, less and less so up
/// to 0.07. Elbows bend to the same side in the picture; no bone becomes longer than its length.
void keep_touches(const FlatPose& source, const BoneLengths& from, const BoneLengths& to, FlatPose& result);

}  // namespace understudy
