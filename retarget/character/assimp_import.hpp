// FBX and DAE through assimp. Damaged files can crash it: call this in a process of its own only.
#pragma once

#include <string>

#include "retarget/character/character.hpp"

namespace understudy {

/// Parts, materials, pictures, nodes, skins, shapes, and animations of nodes. Throws Error.
Character import_by_assimp(const std::string& path);

}  // namespace understudy
