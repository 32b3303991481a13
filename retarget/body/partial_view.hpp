// What is missing of a person's points: sides that no camera saw, limbs that are cut off.
#pragma once

#include "retarget/base/rng.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy {

/// Keeps what one depth camera sees, from any side, a little from above or below.
void see_from_one_side(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);

/// Takes away a hand, a forearm, a foot or a shin with all that follows.
void lose_limb(LabelledPoints& cloud, Rng& rng);

}  // namespace understudy
