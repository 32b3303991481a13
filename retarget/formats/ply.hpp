// PLY, the Stanford format: ascii and binary of both byte orders.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A mesh or cloud from the bytes of a .ply: properties of any type in any order, polygons as fans, triangle
/// strips, colours where there are any; all other elements are stepped over. NaN and infinite coordinates are
/// kept. Throws Error, naming `source`.
Mesh parse_ply(std::string_view bytes, const std::string& source);

}  // namespace understudy
