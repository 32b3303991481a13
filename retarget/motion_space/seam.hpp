// The seam where a movement that is played again and again begins anew.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Bends a movement of two poses or more so that it ends as it begins, elsewhere and whichever way it heads:
/// half of what is missing at either end.
void close_seam(std::vector<Pose>& poses);

}  // namespace understudy
