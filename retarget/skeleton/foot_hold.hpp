// Feet that stand in frames that were made: held where they stand.
#pragma once

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Holds the feet that stand (motion.standing) in frames first .. last; only these change. The ball of a
/// foot stays at one place while it stands, heel and knee go on: where it is beside these frames if it
/// moves no more between, on a line where both such places differ, else where it was on average. A foot
/// that would have to move by more than 0.3 of the leg does not stand after all. A foot that swings is
/// lifted to where the floor (y = 0) is cleared, the higher the faster it is. The legs follow by inverse
/// kinematics, and ease in and out where a foot comes or goes. motion.standing has an entry a frame.
void hold_standing(const Joints& rest, int first, int last, Motion& motion);

}  // namespace understudy
