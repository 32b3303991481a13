// Skeletons as solids: tapered bones and balls, left and right told apart by colour.
#pragma once

#include "render/scene.hpp"

namespace understudy::render {

/// The solids of a skeleton as one coloured mesh with its own normals. Joints that are not finite, and bones
/// to them, are left out. Throws Error when parents or sides do not fit the joints.
MeshView skeleton_solids(const SkeletonView& view);

}  // namespace understudy::render
