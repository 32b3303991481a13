// Biovision motion files.
#pragma once

#include <string>
#include <string_view>

#include "retarget/character/character.hpp"

namespace understudy {

/// The hierarchy as nodes, in the pose of its offsets, and the motion as their one animation; no part.
/// Channels may come in any order, on any joint; an end site is a node named after its joint with "_end".
/// Units and axes are the file's. Throws Error naming `path` and the line: no hierarchy, deeper than 1000
/// joints, more than 10000, an impossible number of frames or frame time, fewer numbers than the frames
/// need.
Character parse_bvh(std::string_view text, const std::string& path);
Character read_bvh(const std::string& path);

}  // namespace understudy
