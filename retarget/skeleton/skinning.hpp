// Linear blend skinning.
#pragma once

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Where each joint takes what follows it, about the world's origin, from the T-pose: row j holds the
/// rotation, row by row, then the translation.
using JointTransforms = Eigen::Matrix<float, kJointCount, 12, Eigen::RowMajor>;
JointTransforms joint_transforms(const Joints& rest_joints, const PosedSkeleton& posed);

/// Vertices of a posed body, [V, 3] metres: each rest vertex follows the joints by its weights.
/// rest [V, 3] T-pose vertices (with pose-corrective offsets already added); weights [V, 22], rows sum to 1;
/// rest_joints the T-pose joints. Throws Error when the sizes disagree.
Points linear_blend_skinning(const Points& rest, const RowMatrix& weights, const Joints& rest_joints,
                             const PosedSkeleton& posed);

}  // namespace understudy
