// What makes a posed person's points hard to read: wide skirts, thick coats, hair, things in a hand, sides
// that no camera saw, limbs that are cut off. Truths stay as they are.
#pragma once

#include "retarget/base/rng.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy {

/// A skirt or dress: from the waist to somewhere between thigh and floor, as wide as the legs in it, wider
/// downwards, in folds. Legs under it are no longer seen. Nothing where the legs are too far apart to be
/// under one.
void wear_skirt(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);

/// Trunk and arms thicker by up to 6 cm.
void wear_coat(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);

/// A bun on the head, or hair all round it but for the face.
void wear_hair(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);

/// A stick or a ball in one hand.
void hold_thing(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);

/// Keeps what one depth camera sees, from any side, a little from above or below.
void see_from_one_side(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);

/// Takes away a hand, a forearm, a foot or a shin with all that follows.
void lose_limb(LabelledPoints& cloud, Rng& rng);

}  // namespace understudy
