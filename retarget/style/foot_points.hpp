// The points by which feet bear a body.
#pragma once

#include <array>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Ball and ankle of both feet: of a side (0 left, 1 right) those at `side` and `side + 2`.
constexpr std::array<int, 4> kFootPoints = {LeftFoot, RightFoot, LeftAnkle, RightAnkle};

template <typename T>
using FootPoints = std::array<T, kFootPoints.size()>;

/// Of one frame.
struct StyledFeet {
  FootPoints<Vec3> source;    ///< world
  FootPoints<Vec3> styled;    ///< of the styled pose, from its pelvis
  FootPoints<float> bears{};  ///< how much each of the source's bears: 1 on the floor .. 0
};

inline FootPoints<Vec3> foot_points(const Joints& joints) {
  FootPoints<Vec3> points;
  for (size_t k = 0; k < points.size(); ++k) points[k] = joints.row(kFootPoints[k]).transpose();
  return points;
}

}  // namespace understudy
