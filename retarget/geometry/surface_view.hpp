// What a camera sees of a surface: the nearest face at every pixel.
#pragma once

#include <limits>
#include <vector>

#include "retarget/geometry/pinhole.hpp"

namespace understudy {

/// Row by row from the top left, a value a pixel; what is seen is seen at the pixel's middle.
struct SurfaceView {
  static constexpr float kNothing = std::numeric_limits<float>::infinity();

  int width = 0, height = 0;
  std::vector<float> depth;  ///< metres before the eye, kNothing where there is no surface
  std::vector<int> face;     ///< the nearest, -1 where there is none
  std::vector<Vec3> shares;  ///< of the face's three corners at the place seen; they sum to 1

  size_t at(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width) + x; }
  bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// Faces are seen from both sides; those that reach behind the eye are left out. A cloud is not seen.
SurfaceView surface_view(const Pinhole& camera, int width, int height, const Points& vertices,
                         const Faces& faces);

}  // namespace understudy
