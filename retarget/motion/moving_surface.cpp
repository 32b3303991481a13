#include "retarget/motion/moving_surface.hpp"

namespace understudy {

MovingSurface::MovingSurface(const Character& character)
    : character_(character), merged_(merged_surface(character, bind_pose(character).vertices)) {}

Mesh MovingSurface::at(const PosedNodes& posed) const {
  const Points all = posed_vertices(character_, posed.world, posed.shape_weights);
  Mesh mesh = merged_.mesh;
  for (Eigen::Index v = 0; v < all.rows(); ++v) mesh.vertices.row(merged_.map[v]) = all.row(v);
  return mesh;
}

}  // namespace understudy
