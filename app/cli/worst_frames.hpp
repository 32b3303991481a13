// Pictures of the frames in which a skeleton was seen worst.
#pragma once

#include <string>
#include <vector>

#include "app/run/breakdown.hpp"

namespace understudy::app {

/// FOLDER/worst_01.png ... each from two sides, and worst.png with all of them: the scan, the skeleton seen
/// in it and, in green, the true one. Nothing for no frames.
void write_worst_frames(const std::string& folder, const std::vector<WorstFrame>& frames);

}  // namespace understudy::app
