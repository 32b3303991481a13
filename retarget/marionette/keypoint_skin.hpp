// A skin for a surface about keypoints, by distance alone (paper 3, Algorithm 2).
#pragma once

#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// Paper 3, Algorithm 2, of the surface [V, 3] in which the keypoints were found; bones are the keypoints. A
/// vertex belongs to the bone whose middle, between keypoint and parent, is nearest, and is shared by the two
/// of them by a Gaussian of its distances, whose size is a share of the surface's box; of the root's it is
/// wholly. Keypoints fainter than kLeastIntensity have no vertex, their children hang on the next brighter
/// one above. parents [K], -1 the root. Throws Error where all are faint or sizes disagree.
SkinWeights skin_of_keypoints(const Points& surface, const FoundKeypoints& keypoints,
                              const std::vector<int>& parents);

}  // namespace understudy
