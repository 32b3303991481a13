// A box that stands about in a scene: furniture.
#pragma once

#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/math/types.hpp"

namespace understudy {

struct Block {
  Vec3 centre = Vec3::Zero();  ///< metres
  Vec3 half = Vec3::Ones();    ///< half its size along its own axes
  Mat3 axes = Mat3::Identity();

  /// The point in its own axes, from its centre.
  Vec3 own(const Vec3& x) const { return axes.transpose() * (x - centre); }
  /// Square metres.
  float surface() const;
  /// A point of its surface, all alike likely.
  Vec3 sample(Rng& rng) const;
  /// Whether it lies between two points, or one is in it.
  bool blocks(const Vec3& from, const Vec3& to) const;
};

}  // namespace understudy
