// OBJ, Wavefront's text format: its vertices (with colours where they follow the position) and faces.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Vertices and faces of all objects and groups of a .obj; materials, lines, curves are ignored. Throws
/// Error, naming `source`.
Mesh parse_obj(std::string_view bytes, const std::string& source);

}  // namespace understudy
