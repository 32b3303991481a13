// A 2D pose and a person as numbers for the network of Zheng et al. (2021), engine `paper`.
#pragma once

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// The paper scales all poses alike into -1 .. 1. Here a unit is this share of the person's stature: of
/// somebody 1.70 m tall 0.958 m, which holds people with their arms up.
constexpr float kPoseCodeUnit = 0.5635f;
constexpr int kPoseCodeInputs = 3;

/// A row a point: x to the right and y up from the middle of the points' box, units; 1 where the point is
/// seen, else all zeros (the mask is ours: the paper's poses lack nothing).
using PoseCodeInput = Eigen::Matrix<float, kPaperPoints, kPoseCodeInputs, Eigen::RowMajor>;
/// stature: pixels. Throws Error when fewer than two points are seen, one is not finite, or the stature is
/// not above 0.
PoseCodeInput pose_code_input(const FlatPose& pose, float stature);

/// Of each bone the logarithm of its share of the stature. The paper's encoder of a person sees poses of
/// theirs; here all engines are told proportions, which are read off such poses.
using PersonCodeInput = Eigen::Matrix<float, 1, kFlatBoneCount>;
/// Throws Error when a length is not above 0.
PersonCodeInput person_code_input(const BoneLengths& lengths);

}  // namespace understudy
