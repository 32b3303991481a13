// The tree of a kind's keypoints, from how much each belongs to each other one.
#pragma once

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// Paper 3, Algorithm 1. affinities: N matrices A_n, [K, K], N < K (eq. 12); each keypoint has as many
/// neighbours as there are matrices. The root has the shortest ways to all others; pieces that hang on
/// nothing are joined root to root. Returns each keypoint's parent, -1 of the root. Throws Error for no
/// matrix, other shapes, or numbers that are not finite.
std::vector<int> tree_of_affinity(const std::vector<RowMatrix>& affinities);

}  // namespace understudy
