// Scans, targets and cases as files, made on the spot from the built-in person.
#pragma once

#include <string>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy::tests {

/// Points as a binary PLY.
void write_cloud(const std::string& path, const Points& points);
void write_text(const std::string& path, const std::string& text);
/// The built-in person's T-pose as an OBJ.
void write_target(const std::string& path);
/// 2,500 points on the built-in person, who glides 2 cm a frame; another draw of points in every frame.
Points person_points(int frame);
std::string frame_name(int frame);
/// Frames 0 .. count-1 in a new folder.
void write_scans(const std::string& folder, int count);

/// Another motion of the mean adult as an AMASS-format .npz.
struct WalkOptions {
  std::string motion = "walk";  ///< the built-in one, or "still": nobody steps
  float fps = 30;               ///< told by the file: twice 30 is walked in half the time
  bool mirrored = false;
  int first = 0, last = 1000;  ///< frames that are written, as far as there are any
};
void write_walk(const std::string& path, const WalkOptions& options = {});

}  // namespace understudy::tests
