// A rig by who knows nothing of parts: points of the first frame, followed, are the joints.
#pragma once

#include "retarget/rig/rig.hpp"

namespace understudy {

/// `nodes` far-apart points of the first frame [N, 3], metres, each followed as the nearest point of the next
/// frame. Their tree is the one of least total length in the first frame; each point of the first frame is
/// carried by the nearest node, and each node turns with those that hang on it. The surface is the first
/// frame, as is the rest pose. Of fewer points all are nodes. Throws Error where a frame has no finite point.
RiggedMotion node_rig(const std::vector<Points>& frames, double fps, int nodes = 24);

}  // namespace understudy
