// How near one 2D pose is to another (Zheng et al. 2021, section 4; COCO's keypoint similarity). Of the first
// 15 points of BODY_25; what is missing on either side does not count, and where nothing is left NaN comes
// out. Boxes' centres lie on each other unless it says otherwise.
#pragma once

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// 100 times the mean of exp(-d^2 / (2 A k^2)): d between points, A 0.53 of the area of the truth's box, k
/// twice COCO's sigmas (the neck as a shoulder, the mid-hip as a hip).
double keypoint_similarity(const FlatPose& pose, const FlatPose& truth);
/// 100 times the mean distance over the diagonal of the truth's box.
double normalised_point_error(const FlatPose& pose, const FlatPose& truth);
/// Per cent of the pairs of points, in the directions x, y, x + y, x - y, that lie in the other order than in
/// the source.
double order_violation(const FlatPose& pose, const FlatPose& source);
/// Root of the mean squared angle between bones and the source's, radians.
double bone_angle_error(const FlatPose& pose, const FlatPose& source);
/// 100 times the mean over bones of |share of all lengths over its true share - 1|.
double bone_ratio_error(const BoneLengths& believed, const BoneLengths& truth);

/// Hands that touch in the source and in the pose. Statures in pixels.
struct Touches {
  int near = 0;  ///< pairs (kHandPairs) nearer than a twentieth of the stature in the source
  int kept = 0;  ///< of those, nearer than 0.08 of it in the pose
};
Touches touches_kept(const FlatPose& pose, double stature, const FlatPose& source, double source_stature);

/// `pose` moved so that the centre of its box lies on that of `truth`'s: of the points that both have.
FlatPose centred_on(const FlatPose& pose, const FlatPose& truth);

}  // namespace understudy
