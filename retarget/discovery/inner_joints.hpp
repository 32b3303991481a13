// Joints lie inside the body.
#pragma once

#include "retarget/discovery/deformation_graph.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// Motion hardly tells where a joint lies along what both bones turn about, and cloth has it lie in the air:
/// joints outside the rest frame's surface, or hardly below it, go to the nearest middle of a ball that fits
/// inside. Root and axes stay. graph: of that frame.
void draw_joints_inside(const ThinnedFrame& rest, const DeformationGraph& graph, Rig& rig);

}  // namespace understudy
