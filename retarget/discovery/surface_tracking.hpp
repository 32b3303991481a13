// A surface followed through scans without correspondence: non-rigid ICP on a deformation graph.
#pragma once

#include <functional>
#include <vector>

#include "retarget/discovery/deformation_graph.hpp"

namespace understudy {

/// The surface of one frame, followed through all.
struct SurfaceTracks {
  DeformationGraph graph;  ///< of the rest frame
  int rest_frame = 0;
  std::vector<NodeMotions> motions;  ///< [T]
  /// The points in a frame, [N, 3].
  Points at(int frame) const { return deformed(graph, motions[static_cast<size_t>(frame)]); }
};

/// Called after each frame, from one of two threads; false ends the work: frames that were not reached stay
/// as the last that was.
using TrackingProgress = std::function<bool()>;

/// From the rest frame forwards and backwards, a thread each. Each frame: Gauss-Newton over the nodes'
/// motions; points come to lie on the scan and the scan on them (point to plane, Geman-McClure with a
/// shrinking radius), neighbouring nodes agree about each other's places (as rigid as possible, with
/// weights that fall where they cannot: at joints, and where two limbs only touched). The same frames give
/// the same bytes.
SurfaceTracks track_surface(const std::vector<ThinnedFrame>& frames, int rest_frame, int nodes,
                            const TrackingProgress& progress = {});

/// Follows once more, each frame for itself, from where its nodes are by now thought to be: `motions` [T] is
/// where to start and then what was found. Cures what drifted.
void track_again(const std::vector<ThinnedFrame>& frames, SurfaceTracks& tracks,
                 const TrackingProgress& progress = {});

}  // namespace understudy
