// How far two moving bodies are from each other as paper 3 measures it: on a grid, of 64 x 64 x 64 where
// nothing else is said.
#pragma once

#include <array>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

constexpr int kVoxels = 64;  ///< along the paper's edge; the first and last centres are at -1 and 1
/// Numbers of occupied cells, rising.
using VoxelSet = std::vector<int>;

/// The one cube about all frames of a sequence, scaled to [-1, 1]^3. Throws Error where there is no point.
class VoxelGrid {
 public:
  explicit VoxelGrid(const std::vector<Points>& frames, int edge = kVoxels);
  /// Cells that points are in; those outside are put on the border, those not finite left out.
  VoxelSet cells(const Points& points) const;
  /// The same, each point's own, in their order.
  std::vector<int> cells_of_each(const Points& points) const;
  /// Centres in [-1, 1]^3, [N, 3].
  static Points centres(const VoxelSet& cells, int edge = kVoxels);
  /// Places of the world in [-1, 1]^3, and back, [N, 3].
  Points scaled(const Points& world) const;
  Points world(const Points& scaled) const;

 private:
  int edge_;
  Vec3 middle_;
  float half_;  // metres
};

/// Mean squared distance from each cell's centre to the nearest of the other set, both directions added, in
/// [-1, 1]^3. 0 where both are empty, 4 (a whole edge, squared) where one is.
double voxel_distance(const VoxelSet& a, const VoxelSet& b, int edge = kVoxels);

/// Errors of the set `found` of each frame against the true one.
struct VoxelErrors {
  double cd_1e4 = 0;  ///< 10,000 times the mean of voxel_distance()
  double m_cd = 0;    ///< eq. 22: mean of that of cells that appear, plus that of cells that vanish, between
                      ///< frames; NaN for one frame. The paper does not say its tables' scale: compare ratios
};
/// Throws Error for no frame, or different numbers of frames.
VoxelErrors voxel_errors(const std::vector<VoxelSet>& found, const std::vector<VoxelSet>& truth);
/// The same of surfaces, [T] of [V, 3], in the box of the true ones, as the paper has it: the true cells are
/// those of 20,000 points drawn on the surface, the found ones those that so many points of theirs would more
/// likely be in than not (a decoder's occupancy above 0.5); of clouds those of their points. Drawn points
/// miss cells: the true surface itself scores cd_1e4 0.2 to 1.4, the more the larger its share of the box.
VoxelErrors voxel_errors(const std::vector<Points>& found, const Faces& found_faces,
                         const std::vector<Points>& truth, const Faces& true_faces);

}  // namespace understudy
