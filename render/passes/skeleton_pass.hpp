// Skeletons as solids: tapered bones and balls, left and right told apart by colour.
#pragma once

#include "render/passes/mesh_pass.hpp"

namespace understudy::render {

/// The solids of a skeleton as one coloured mesh with its own normals. Joints that are not finite, and bones
/// to them, are left out. Throws Error when parents or sides do not fit the joints.
MeshView skeleton_solids(const SkeletonView& view);

class SkeletonPass {
 public:
  /// Draws with the mesh pass's shader; the caller clears depth first for an x-ray view.
  void draw(MeshPass& meshes, const SkeletonView& view) { meshes.draw(skeleton_solids(view), 0); }
};

}  // namespace understudy::render
