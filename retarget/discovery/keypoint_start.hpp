// What a network of the kind sees in scans, as a start for finding a rig: a surface that follows keypoints,
// and the part of each.
#pragma once

#include "retarget/discovery/part_tree.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"

namespace understudy {

struct KeypointStart {
  SurfaceTracks tracks;
  RigidParts parts;     ///< one a keypoint, in their order
  Points places{0, 3};  ///< [K, 3] of the keypoints in the rest frame
};
/// Each point of the rest frame goes with the keypoint that owns it; keypoints that own nothing there get the
/// nearest point. name: of the scans, for messages. Throws Error as finder.find() does.
KeypointStart start_from_keypoints(const std::vector<ThinnedFrame>& frames, int rest_frame, int nodes,
                                   KeypointFinder& finder);

/// The tree of a network's keypoints [K], each a part, as one frame shows them: joints at their places, free.
/// `parents` [K], -1: the root.
PartTree tree_of_keypoints(const Points& places, const std::vector<int>& parents);

/// Names each bone after the keypoint that owns most of its surface; no two alike, and where there are more
/// bones than keypoints the smallest keep their names. keypoint_of_point [N]: of the surface of `skin`.
void name_after_keypoints(const std::vector<int>& keypoint_of_point, const SkinWeights& skin, Rig& rig);

}  // namespace understudy
