// Reads a mesh or point cloud from a file of any known format, by what is in it.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A mesh or point cloud in the file's own units and axes. What the bytes are decides, the suffix helps where
/// they do not show it; where the two disagree, the bytes count and a warning is given. NaN and infinite
/// coordinates are kept. Throws Error: one sentence that names the file.
Mesh read_mesh(const std::string& path);
/// The same from bytes in memory; `path` gives the suffix and names the file in errors.
Mesh parse_mesh(std::string_view bytes, const std::string& path);

}  // namespace understudy
