// Changes of a rig's tree.
#pragma once

#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

/// A bone and its parent become one: what hangs on it hangs on the parent, which takes over its skin. Returns
/// the new number of each joint that was there, [J]; that of the merged one is its parent's. Throws Error for
/// the root and for a number that is no joint's.
std::vector<int> merge_into_parent(Rig& rig, int joint);

/// Weights of joints that are numbered anew; those of one number add up.
SkinWeights renumbered(const SkinWeights& skin, const std::vector<int>& numbers);

}  // namespace understudy
