#include "render/camera.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace understudy::render {
namespace {

constexpr float kMaxPitch = 1.55f;  // at the poles "up" has no direction

/// Half the picture's width and height at distance 1.
Eigen::Vector2f half_extent(const Camera& camera, float aspect) {
  const float half = std::tan(camera.fov / 2);
  return {half * aspect, half};
}

}  // namespace

Pinhole pinhole(const Camera& camera, PixelSize size) {
  Pinhole out = looking_at(camera.target, axes(camera), camera.distance);
  out.focal = static_cast<float>(size.height) / 2 / half_extent(camera, 1).y();
  if (camera.orthographic) out.focal /= camera.distance;
  out.centre = {static_cast<float>(size.width) / 2, static_cast<float>(size.height) / 2};
  out.orthographic = camera.orthographic;
  return out;
}

Mat3 axes(const Camera& camera) {
  return camera_axes(camera.yaw, camera.pitch);
}

Vec3 eye(const Camera& camera) {
  return camera.target + camera.distance * axes(camera).col(2);
}

Mat4 view_matrix(const Camera& camera) {
  const Mat3 R = axes(camera);
  Mat4 view = Mat4::Identity();
  view.topLeftCorner<3, 3>() = R.transpose();
  view.topRightCorner<3, 1>() = -R.transpose() * eye(camera);
  return view;
}

Mat4 projection_matrix(const Camera& camera, float aspect) {
  const Eigen::Vector2f half = half_extent(camera, aspect);
  Mat4 P = Mat4::Zero();
  if (camera.orthographic) {
    const float far = camera.distance + 50, near = -far;
    P.diagonal() << 1 / (half.x() * camera.distance), 1 / (half.y() * camera.distance), -2 / (far - near), 1;
    P(2, 3) = -(far + near) / (far - near);
  } else {
    const float near = std::max(0.01f, camera.distance * 0.05f), far = camera.distance * 10 + 50;
    P.diagonal() << 1 / half.x(), 1 / half.y(), -(far + near) / (far - near), 0;
    P(2, 3) = -2 * far * near / (far - near);
    P(3, 2) = -1;
  }
  return P;
}

Ray ray_through(const Camera& camera, float aspect, const Eigen::Vector2f& place) {
  const Mat3 R = axes(camera);
  const Eigen::Vector2f at = place.cwiseProduct(half_extent(camera, aspect));
  if (camera.orthographic)
    return {eye(camera) + camera.distance * (R.col(0) * at.x() + R.col(1) * at.y()), -R.col(2)};
  return {eye(camera), (R.col(0) * at.x() + R.col(1) * at.y() - R.col(2)).normalized()};
}

Ray ray_through(const Camera& camera, PixelSize size, const Eigen::Vector2f& pixel) {
  return ray_through(camera, size.aspect(),
                     {2 * pixel.x() / static_cast<float>(size.width) - 1,
                      1 - 2 * pixel.y() / static_cast<float>(size.height)});
}

Vec3 on_screen(const Camera& camera, PixelSize size, const Vec3& point) {
  Vec3 place = pinhole(camera, size).project(point);
  if (camera.orthographic) place.z() -= camera.distance;
  return place;
}

float metres_a_pixel(const Camera& camera, PixelSize size, const Vec3& point) {
  const float away =
      camera.orthographic ? camera.distance : std::max(0.01f, (eye(camera) - point).dot(axes(camera).col(2)));
  return 2 * away * std::tan(camera.fov / 2) / static_cast<float>(size.height);
}

Camera orbited(Camera camera, float yaw, float pitch) {
  camera.yaw = std::remainder(camera.yaw + yaw, 2 * kPi);
  camera.pitch = std::clamp(camera.pitch + pitch, -kMaxPitch, kMaxPitch);
  return camera;
}

Camera panned(Camera camera, const Eigen::Vector2f& share_of_height) {
  const Mat3 R = axes(camera);
  const float height = 2 * camera.distance * std::tan(camera.fov / 2);
  camera.target -= height * (share_of_height.x() * R.col(0) + share_of_height.y() * R.col(1));
  return camera;
}

Camera zoomed(Camera camera, float factor) {
  camera.distance = std::clamp(camera.distance * factor, 0.05f, 500.f);
  return camera;
}

float fitting_distance(const Camera& camera, const Points& points, float aspect, float margin) {
  const Eigen::Vector2f half = half_extent(camera, aspect) * (1 - 2 * margin);
  const Mat3 R = axes(camera);
  float distance = 0.05f;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    // camera axes, from the target
    const Vec3 p = R.transpose() * (points.row(i).transpose() - camera.target);
    const float needed = std::max(std::abs(p.x()) / half.x(), std::abs(p.y()) / half.y());
    // A point nearer to the eye by p.z looks larger; the orthographic picture does not care.
    distance = std::max(distance, camera.orthographic ? needed : needed + p.z());
  }
  return distance;
}

Camera fitted(Camera camera, const Points& points, float aspect, float margin) {
  if (points.rows() == 0) return camera;
  const Mat3 R = axes(camera);
  const Points seen = points * R;  // camera axes
  camera.target = R * ((seen.colwise().minCoeff() + seen.colwise().maxCoeff()) / 2).transpose();
  camera.distance = fitting_distance(camera, points, aspect, margin);
  return camera;
}

}  // namespace understudy::render
