// When feet stand on the floor, of a motion that is there as a whole.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Both feet over joints every `dt` seconds, looking forwards and then backwards (ContactSwitch): a foot
/// stands where either sees it stand. What is lowest of a ball in all of them is where it stands. `leg`:
/// leg_length. There is a frame at least.
std::vector<Standing> stances(const std::vector<Joints>& joints, float dt, float leg);

}  // namespace understudy
