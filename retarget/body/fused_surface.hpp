// What fusing and smoothing many views does to a surface: gaps close, thin parts fatten, shrink or vanish,
// points lie on a grid, and the thickness is uneven.
#pragma once

#include <optional>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy {

/// Points of a person with the side that is outside.
struct OrientedPoints : LabelledPoints {
  Points normals;  ///< [N, 3] unit
};
void keep_rows(OrientedPoints& cloud, const std::vector<int>& kept);

/// A closed surface seen through a soft kernel (Plummer's, 3 s^2 / (4 pi (r^2 + s^2)^(5/2)) with softness s):
/// how much of the kernel about a place lies inside. It is the winding number of a cloud (Barill et al. 2018,
/// eq. 5) with r^3 softened to (r^2 + s^2)^(3/2). Gaps narrower than s count as inside, parts thinner than s
/// as nearly outside.
class SoftSolid {
 public:
  /// points [N, 3] on the surface, normals outwards, each point for `area` square metres; softness in metres,
  /// at least about the distance of neighbouring points.
  SoftSolid(const Points& points, const Points& normals, float area, float softness);

  struct Value {
    float inside = 0;           ///< 1 deep inside, 1/2 on a flat surface, 0 outside
    Vec3 slope = Vec3::Zero();  ///< its gradient, to the inside, a metre
  };
  Value at(const Vec3& x) const;
  /// Where `inside` is `level`, from x along the gradient; nothing where that is farther than `farthest`
  /// metres, or nowhere.
  std::optional<Vec3> level_point(const Vec3& x, float level, float farthest) const;
  float softness() const { return softness_; }

 private:
  /// Neighbouring points, four at a time; from afar they count as one.
  struct Cell {
    size_t begin, end;  // of blocks_
    Vec3 middle, area;  // sum of areas along the normals
    float near;         // squared distance below which each point counts
  };
  struct Block {
    Eigen::Array4f x, y, z, nx, ny, nz;  // normals times area
  };
  void add_cell(const Points& points, const Points& normals, const std::vector<int>& rows);

  float area_, softness_;
  std::vector<Cell> cells_;
  std::vector<Block> blocks_;
};

/// Fills what is concave as far as the solid closes it: armpits, crotch, arms at the
/// trunk. Rows whose filled place is not found are hidden: they are dropped.
void weld(OrientedPoints& cloud, const SoftSolid& solid, float level);

/// A hand (0 left, 1 right) as a fused one of that solid: fingers merged to a mitten or a blob, thicker or
/// thinner. `solid` is of the hand and some of the forearm. What is inside is dropped.
void fuse_hand(OrientedPoints& cloud, const PosedSkeleton& truth, int side, const SoftSolid& solid,
               float level);

/// Points as vertices on the edges of a grid of 8 to 25 mm, smoothed by some share. The same rng state, the
/// same grid in the world.
void snap_to_voxels(OrientedPoints& cloud, Rng& rng);

/// Limbs thicker or thinner by up to 15 mm, and patches that bulge or sink, as smoothing leaves them; fixed
/// to the T-pose surface.
class UnevenSurface {
 public:
  /// vertices [V, 3] of the T-pose, some of which patches are about.
  UnevenSurface(const Points& vertices, const Joints& joints, Rng& rng);
  /// Moves T-pose points [N, 3] along their normals.
  void apply(Points& points, const Points& normals, const RowMatrix& weights) const;

 private:
  struct Patch {
    Vec3 middle;
    float radius, height;
  };
  Eigen::Matrix<float, kJointCount, 1> thicker_;
  std::vector<Patch> patches_;
};

}  // namespace understudy
