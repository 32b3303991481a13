// A simulated multi-view capture: what a rig of depth cameras would see of a posed body.
#pragma once

#include <cstdint>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

struct CaptureOptions {
  int views = 7;            ///< cameras in a ring about the body, low and high in turn, >= 1
  int points = 5000;        ///< about how many on the body; the count differs from frame to frame
  float noise = 0.004f;     ///< standard deviation along the camera's ray, metres
  float outliers = 0.003f;  ///< share of points that lie off the body
  float floor = 0.05f;      ///< share of points on the floor about the feet
  int holes = 5;            ///< spots a frame, 3 to 7 cm wide, where little is seen
  uint64_t seed = 1;        ///< of the rig: places and gains of the cameras, holes that stay
};

/// The cloud of one frame: only surface that some camera sees, dense where cameras look straight at it, with
/// noise, holes, outliers and some floor (y = 0), in no order. The same options, mesh and frame number give
/// the same bytes. Throws Error when the mesh has no faces or an option is out of range.
Mesh simulated_capture(const Points& vertices, const Faces& faces, int frame,
                       const CaptureOptions& options = {});

}  // namespace understudy
