// Skeletons seen in scans of few points.
#pragma once

#include <vector>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// So many points on the triangles between near ones: an extractor that knows dense scans makes more of them
/// than of the points alone. Where these are many they stay as they are. `variant`: which of many ways.
Points filled_between(const Points& points, int count, uint64_t variant);

/// What an extractor sees, in several ways of filling where the points are few. Empty without finite numbers.
std::vector<Extraction> looks(SkeletonExtractor& extractor, const Points& points, int ways);

}  // namespace understudy
