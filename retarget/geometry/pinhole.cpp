#include "retarget/geometry/pinhole.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace understudy {

Vec3 Pinhole::project(const Vec3& point) const {
  const Vec3 seen = rotation.transpose() * (point - position);  // camera axes, from the eye
  const float depth = -seen.z(), scale = pixels_a_metre(depth);
  return {centre.x() + scale * seen.x(), centre.y() - scale * seen.y(), depth};
}

Points Pinhole::project(const Points& points) const {
  Points places(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    places.row(i) = project(Vec3(points.row(i).transpose())).transpose();
  return places;
}

Vec3 Pinhole::unproject(const Eigen::Vector2f& place, float depth) const {
  const Eigen::Vector2f across = (place - centre) / pixels_a_metre(depth);
  return position + rotation * Vec3(across.x(), -across.y(), -depth);
}

Mat3 camera_axes(float yaw, float pitch) {
  const float cy = std::cos(yaw), sy = std::sin(yaw);
  const float cp = std::cos(pitch), sp = std::sin(pitch);
  const Vec3 back(sy * cp, sp, cy * cp);
  const Vec3 right(cy, 0, -sy);
  Mat3 R;
  R << right, back.cross(right), back;
  return R;
}

Pinhole looking_at(const Vec3& target, const Mat3& axes, float distance) {
  Pinhole camera;
  camera.rotation = axes;
  camera.position = target + distance * axes.col(2);
  return camera;
}

}  // namespace understudy
