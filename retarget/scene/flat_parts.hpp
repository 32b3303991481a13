// Walls, table tops and other large flat things.
#pragma once

#include <vector>

#include "retarget/geometry/cells.hpp"

namespace understudy {

/// A flat rectangle in the world.
struct FlatPart {
  Vec3 centre = Vec3::Zero();
  Mat3 axes = Mat3::Identity();                ///< columns: along, along, normal
  Eigen::Vector2f half = {0, 0};               ///< metres from the centre along the first two
  static constexpr float kThickness = 0.035f;  ///< metres to either side
  bool holds(const Vec3& point) const {
    const Vec3 own = axes.transpose() * (point - centre);
    return std::abs(own.z()) <= kThickness && std::abs(own.x()) <= half.x() && std::abs(own.y()) <= half.y();
  }
};

/// Flat parts too large to be somebody's, among the cells taken: upright ones of 0.9 square metres and level
/// ones of 0.3 with nothing above. At most `most`, the largest first. Deterministic.
std::vector<FlatPart> find_flat_parts(const Cells& cells, const std::vector<char>& taken, int most);

}  // namespace understudy
