// What goes along with the 15 points that engines move: eyes, ears, feet, hands, face.
#pragma once

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// Adds to `pose`, which has its first 15 points, the others of `source`: eyes, ears and face about the nose
/// (without one about the neck) as far as the head's length, toes and heels about the ankles as the legs',
/// hands about the wrists as the forearms'. ratio: of each bone in `pose` to that in `source`. What hangs on
/// a missing point is missing.
void ride_along(const FlatPose& source, const BoneLengths& ratio, FlatPose& pose);

}  // namespace understudy
