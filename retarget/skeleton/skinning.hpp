// Linear blend skinning.
#pragma once

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Vertices of a posed body, [V, 3] metres: each rest vertex follows the joints by its weights.
/// rest [V, 3] T-pose vertices (with pose-corrective offsets already added); weights [V, 22], rows sum to 1;
/// rest_joints the T-pose joints. Throws Error when the sizes disagree.
Points linear_blend_skinning(const Points& rest, const RowMatrix& weights, const Joints& rest_joints,
                             const PosedSkeleton& posed);

}  // namespace understudy
