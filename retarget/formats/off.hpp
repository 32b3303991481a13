// OFF, Geomview's format, ascii and binary, with its prefixes for colours, normals and texture coordinates.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A mesh or cloud from the bytes of a .off ([ST][C][N]OFF [BINARY]). Throws Error, naming `source`.
Mesh parse_off(std::string_view bytes, const std::string& source);

}  // namespace understudy
