// Points in an order in which neighbours follow each other.
#pragma once

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy::nn {

/// All rows of points, [N, 3], along a Z-order curve. What lies side by side looks alike to a network: whole
/// blocks of rows have their zeros at the same places, and those are skipped (Product::sparse).
std::vector<int> near_order(const Points& points);

}  // namespace understudy::nn
