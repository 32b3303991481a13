// The surface of a found rig whose scans are clouds: closed, from all frames brought to rest.
#pragma once

#include <vector>

#include "retarget/discovery/articulated_fit.hpp"

namespace understudy {

/// What was seen of a body: its frames, where its bones are in each, and points of its surface at rest.
struct SeenBody {
  const std::vector<ThinnedFrame>& frames;
  const std::vector<BoneMotions>& bones;  ///< [frames]
  const FittedSurface& surface;
};

/// Brings the points of all frames to rest by the inverse of what their bones did and lays a closed surface
/// of 7,000 vertices or so through them, with weights that change smoothly across joints. Points that few
/// frames show, and those further from the surface than its points are apart, are left out. Colours are those
/// of the nearest points of `rest`, the rest frame's scan, if it has any. Throws Error where the points
/// enclose nothing.
void set_rest_surface(const SeenBody& body, const Mesh& rest, Rig& rig);

}  // namespace understudy
