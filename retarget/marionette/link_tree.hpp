// The tree of a kind's keypoints from what it costs that one hangs on another.
#pragma once

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// The tree of least cost, as parents: costs [K, K], of a pair the lesser of both. Its root is the keypoint
/// from which the others are fewest steps away (paper 3, Algorithm 1), the first such one; -1 there. Throws
/// Error where the matrix is empty, not square, or has costs that are not finite off its diagonal.
std::vector<int> tree_of_links(const RowMatrix& costs);

}  // namespace understudy
