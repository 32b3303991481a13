// People on chairs: what clips lack.
#pragma once

#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The same in all poses of somebody: the trunk upright, thighs forwards, shins down; the rest stays.
void sit_down(std::vector<Pose>& poses, Rng& rng);

}  // namespace understudy
