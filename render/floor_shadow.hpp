// Soft shadows on the floor: how much of the sky each place has lost.
#pragma once

#include <array>
#include <cstdint>

#include "render/scene.hpp"

namespace understudy::render {

/// A small picture of the floor seen from above.
struct FloorShadow {
  static constexpr int kSide = 80;  ///< cells
  Vec3 area = Vec3(-1, -1, 2);      ///< x, z of its corner and its side, metres
  /// 255: no light at all; row by row along x; fades to 0 at its edges
  std::array<uint8_t, kSide * kSide> dark{};
};

/// Of all that stands in the scene: everything flattened onto the floor, darker the lower it is, then
/// blurred.
FloorShadow floor_shadow(const Scene& scene);

}  // namespace understudy::render
