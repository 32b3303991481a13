// XYZ, TXT, CSV, ASC, PTS: a point a line.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A cloud from lines of numbers parted by blanks, commas or semicolons. The first three are the position,
/// unless a line of column names says otherwise; colours are taken from columns named so, or from three more
/// numbers that can be no normal. A leading count and lines that start with # or // are stepped over. Throws
/// Error, naming `source`.
Mesh parse_xyz(std::string_view bytes, const std::string& source);

}  // namespace understudy
