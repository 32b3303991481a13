// Something to look at where a file holds bones alone.
#pragma once

#include "retarget/character/bone_map.hpp"

namespace understudy {

/// Adds a part to a character that has none: an octahedron from each bone under the pelvis to each of its
/// children, bound to the bones in the pose of the nodes. Throws Error naming the character when its bones are
/// not known or none has a length.
void add_bone_shapes(Character& character, const BoneChoices& choices);

/// Throws Error naming the character when too few of the 22 joints are known to perform.
void check_bones(const BoneMap& map, const std::string& name);

}  // namespace understudy
