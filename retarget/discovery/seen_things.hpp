// What scans show beside the one thing whose skeleton is looked for.
#pragma once

#include <string>
#include <vector>

#include "retarget/discovery/thinned_frames.hpp"

namespace understudy {

/// Whether a second large piece is seen that is clearly away from the first.
bool shows_two_things(const ThinnedFrame& frame);
/// Whether a flat ground, y up, reaches beyond what stands on it.
bool shows_ground(const ThinnedFrame& frame);

/// Logs a warning of what more than half of the frames show. name: of the scans.
void warn_of_more_than_one(const std::vector<ThinnedFrame>& frames, const std::string& name);

}  // namespace understudy
