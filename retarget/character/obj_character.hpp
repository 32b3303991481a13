// Characters from Wavefront OBJ: groups by material, texture coordinates, normals, .mtl and its pictures.
#pragma once

#include <string>
#include <string_view>

#include "retarget/character/character.hpp"

namespace understudy {

/// One part a material. Materials and pictures are looked for in the file's folder and under it; what is
/// missing is warned of. Throws Error naming `path`.
Character parse_obj_character(std::string_view bytes, const std::string& path);

}  // namespace understudy
