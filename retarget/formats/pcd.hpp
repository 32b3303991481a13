// PCD, the Point Cloud Library's format: ascii, binary, binary_compressed.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A cloud from the bytes of a .pcd, any fields in any order, packed colours; the NaN points of organised
/// clouds are kept. Throws Error, naming `source`.
Mesh parse_pcd(std::string_view bytes, const std::string& source);

}  // namespace understudy
