// The image of a depth camera whose pixels are coarse cells: which points nothing hides, and where edges are.
#pragma once

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

class CellImage {
 public:
  /// Points [N, 3] as the camera has them: across and up, counted in cells, and nearness, metres, greatest
  /// for the nearest. Throws Error when they are not finite or lie apart by more than kMostCells.
  explicit CellImage(const Points& image);

  /// Whether a point is not more than `depth` behind the nearest of its cell, and not more than one and a
  /// half times that behind the nearest of a cell beside.
  bool shows(int point, float depth) const;
  /// Whether a cell beside is empty, or all it holds is farther than the point by more than `depth`.
  bool is_at_edge(int point, float depth) const;

  static constexpr int kMostCells = 4096;  ///< across and up

 private:
  int width_ = 0;
  std::vector<float> nearest_;  // of each cell; there is an empty cell beside each that is used
  std::vector<int> cell_;       // of each point
  std::vector<float> nearness_;
};

/// The axes of a level camera that looks from one place at another: columns right, up, forwards.
Mat3 camera_axes(const Vec3& from, const Vec3& at);

/// Points as such a camera has them, for a CellImage: cells are as wide as `cell` metres at the place looked
/// at, nearness is less by a metre for each metre forwards.
Points seen_from(const Points& points, const Vec3& from, const Vec3& at, float cell);

}  // namespace understudy
