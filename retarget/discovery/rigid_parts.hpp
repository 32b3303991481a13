// Pieces of a followed surface that move as rigid bodies.
#pragma once

#include <vector>

#include "retarget/discovery/surface_tracking.hpp"

namespace understudy {

struct RigidParts {
  std::vector<int> of_point;                      ///< [N] of the tracked surface its part, 0 ..
  std::vector<std::vector<RigidMotion>> motions;  ///< [parts][T] from rest
  float noise_m = 0;  ///< of followed points about rigid pieces, standard deviation
  int count() const { return static_cast<int>(motions.size()); }
};

/// Joins neighbouring patches as long as one rigid motion a frame explains both (agglomeration by Ward's
/// cost; a union's comes from its moments, exactly), and stops by description length: another part costs
/// six numbers a frame and must explain more than that. Then each point goes to the part about it that
/// explains it best. Parts go where the scans themselves are explained as well without them: what only slid
/// along the surface. `most`: of parts; 0: as many as pay.
RigidParts find_rigid_parts(const std::vector<ThinnedFrame>& frames, const SurfaceTracks& tracks,
                            int most = 0);

/// Numbers parts anew where some are gone, and finds their best motions.
void refit(const SurfaceTracks& tracks, RigidParts& parts);

}  // namespace understudy
