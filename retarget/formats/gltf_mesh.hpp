// The surface in a glTF or GLB file: what a target or a single scan needs of it.
#pragma once

#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// All triangles and points of the default scene in one mesh, with the transforms of their nodes; skinned
/// meshes in their bind pose, placed by the root of their skeleton. Metres and y up are the format's own;
/// colours from COLOR_0 when every primitive has them. Every accessor is checked against its buffer before it
/// is read. `path` is where outside buffers are looked for, and names the file in complaints. Throws Error,
/// also for Draco and meshopt compression.
Mesh parse_gltf(std::string_view bytes, const std::string& path);

}  // namespace understudy
