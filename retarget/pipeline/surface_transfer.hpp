// Retargeting that moves a surface without any skeleton: peers to compare with.
#pragma once

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// A target's vertices in a source's pose, frame by frame. One thread at a time.
class SurfaceTransfer {
 public:
  virtual ~SurfaceTransfer() = default;
  /// Starts anew with a target in T-pose, metres. Throws Error when its vertices are unusable.
  virtual void reset(const Mesh& rest) = 0;
  /// The target's vertices, [V, 3] metres, in its order, for one scan of somebody who faces `heading` radians
  /// about +y from +z. Throws Error when the scan cannot be used or no target was set.
  virtual Points push(const Mesh& scan, float heading) = 0;
};

}  // namespace understudy
