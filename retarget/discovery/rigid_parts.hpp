// Pieces of a followed surface that move as rigid bodies.
#pragma once

#include <vector>

#include "retarget/discovery/surface_tracking.hpp"

namespace understudy {

struct RigidParts {
  std::vector<int> of_node;                       ///< [G] its part, 0 ..
  std::vector<std::vector<RigidMotion>> motions;  ///< [parts][T] from rest
  float noise_m = 0;  ///< of followed points about rigid pieces, standard deviation
  int count() const { return static_cast<int>(motions.size()); }
};

/// Joins neighbouring nodes as long as one rigid motion a frame explains both (agglomeration by Ward's cost; a
/// union's comes from its moments, exactly), and stops by description length: another part costs six numbers
/// a frame and must explain more than that. `most`: of parts; 0: as many as pay. Then nodes go to the
/// neighbouring part that explains them best.
RigidParts find_rigid_parts(const SurfaceTracks& tracks, int most = 0);
/// The best motions of the parts that the nodes belong to now.
void refit(const SurfaceTracks& tracks, RigidParts& parts);

}  // namespace understudy
