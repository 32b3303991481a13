// What a small picture shows of a file or folder. No GL.
#pragma once

#include <optional>
#include <string>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::app {

/// On the floor and around the y axis: a mesh or cloud 1.7 high, or the skeleton of a motion.
struct PreviewContent {
  Mesh mesh;                     ///< of a scan's first frame, or a character upright as it will be imported
  std::optional<Joints> joints;  ///< of a motion, half-way through its longest clip
  std::string text;              ///< "87 frames, 4,202 points"; or why there is nothing to see
};

/// Reads it; never throws. The text of a folder without frames names none of its files. up: which way is up
/// in a scan; empty: as it is guessed.
PreviewContent preview_content(const std::string& path, const std::string& up = "");

}  // namespace understudy::app
