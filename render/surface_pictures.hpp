// Depth, normals and mask of what a camera sees of a surface, as generators of pictures take them.
#pragma once

#include "render/image.hpp"
#include "retarget/geometry/surface_view.hpp"

namespace understudy::render {

/// Metres before the eye. One range for a whole film keeps its pictures from flickering.
struct DepthRange {
  float near = 1, far = 10;
};
/// White at `near`, dark grey at `far`, black where there is nothing.
Image depth_picture(const SurfaceView& seen, const DepthRange& range);

/// Red grows with a normal's way to the right, green with that up, blue with that towards the viewer; 128 is
/// none. Black where there is nothing. Smooth: from the normals of the vertices, [V, 3] in the world.
Image normal_picture(const SurfaceView& seen, const Pinhole& camera, const Faces& faces,
                     const Points& normals);

/// White where there is a surface, else black.
Image mask_picture(const SurfaceView& seen);

}  // namespace understudy::render
