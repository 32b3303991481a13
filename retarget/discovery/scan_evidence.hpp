// How well scans are explained by points of a surface that move so.
#pragma once

#include <vector>

#include "retarget/discovery/surface_tracking.hpp"

namespace understudy {

/// Asks up to 20 of the frames, evenly spread. It keeps references to both.
class ScanEvidence {
 public:
  ScanEvidence(const std::vector<ThinnedFrame>& frames, const DeformationGraph& graph);
  /// Squared distances along the normals if the graph's point moved so from rest ([T]), summed as if all
  /// frames had been asked, m^2; in a frame no more than for a point that is lost, half a node's spacing off.
  double off(int point, const std::vector<RigidMotion>& motions) const;

 private:
  const std::vector<ThinnedFrame>& frames_;
  const DeformationGraph& graph_;
  std::vector<int> judged_;
  double share_;
  float most_;
};

/// What may as well stand still, stands still: round pieces that tracking turned along with what turns beside
/// them, as the foot of a lamp. Changes the motions of their nodes.
void rest_what_may(const std::vector<ThinnedFrame>& frames, SurfaceTracks& tracks);

}  // namespace understudy
