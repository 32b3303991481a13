// The one projection of points in space into a picture: a pinhole camera, or one without perspective.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy {

struct Pinhole {
  Mat3 rotation = Mat3::Identity();  ///< the camera's axes in the world as columns: right, up, back
  Vec3 position = Vec3::Zero();      ///< of the eye, metres
  float focal = 1000;                ///< pixels of a metre at a metre's depth; orthographic: at any depth
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();  ///< where the axis meets the picture, pixels
  bool orthographic = false;

  /// Where a point is seen: x to the right and y down in pixels, then its depth, metres before the eye.
  /// Behind the eye the depth is negative and, in perspective, x and y mean nothing.
  Vec3 project(const Vec3& point) const;
  Points project(const Points& points) const;
  /// The point at `depth` that is seen at a place.
  Vec3 unproject(const Eigen::Vector2f& place, float depth) const;
  /// How many pixels a metre across the view takes there.
  float pixels_a_metre(float depth) const { return orthographic ? focal : focal / depth; }
};

/// The axes of a camera that looks at the front of a T-pose (along -z) at yaw 0, from +x at a yaw of 90
/// degrees, and down from above at a pitch above 0. Radians.
Mat3 camera_axes(float yaw, float pitch);
/// One that sees `target` at `centre`, `distance` metres away.
Pinhole looking_at(const Vec3& target, const Mat3& axes, float distance);

}  // namespace understudy
