// Markers on somebody, as optical motion capture gives them: a table of where each was, and when.
#pragma once

#include <string>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

struct Marker {
  std::string name;
  Vec3 place = Vec3::Zero();  ///< in the units and axes of the file
};

/// All markers that were seen at one time.
struct MarkerFrame {
  double seconds = 0;
  std::vector<Marker> markers;  ///< each name once
};

/// A CSV whose first line names its columns, seconds,name,x,y,z or frame,name,x,y,z, and whose others have a
/// marker each, in any order; parted by comma, semicolon or tab. Frame 0 is at 0 s, others by `fps`; a marker
/// that is not seen has no line. In the order of time. Throws Error naming file and line: no such first line,
/// a cell that is missing, a time that is not finite or, of frames, no whole number from 0, no name, a place
/// that is not finite, one name twice at one time, an hour or more between two times; or where there are
/// fewer than three names, which tell nobody's pose.
std::vector<MarkerFrame> read_markers(const std::string& path, double fps = 30);

/// Writes such a table, by seconds. Throws Error where it cannot be written.
void write_markers(const std::string& path, const std::vector<MarkerFrame>& frames);

}  // namespace understudy
