// STL, ascii and binary.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A mesh from the bytes of a .stl; corners at exactly the same position become one vertex. Throws Error,
/// naming `source`.
Mesh parse_stl(std::string_view bytes, const std::string& source);

}  // namespace understudy
