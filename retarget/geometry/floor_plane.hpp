// A floor as a plane.
#pragma once

#include "retarget/base/fields.hpp"
#include "retarget/math/types.hpp"

namespace understudy {

/// The points x with normal . x = height; normal has unit length and points up.
struct FloorPlane {
  Vec3 normal = Vec3::UnitY();
  float height_m = 0;
  float above(const Vec3& point) const { return normal.dot(point) - height_m; }
};
template <class V, class S>
FieldsOf<S, FloorPlane> fields(V& visit, S& plane) {
  visit("normal", plane.normal);
  visit("height_m", plane.height_m);
}

}  // namespace understudy
