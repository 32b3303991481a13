// An orbit camera: its state, its matrices, and fitting it to a scene.
#pragma once

#include <Eigen/Core>

#include "retarget/base/fields.hpp"
#include "retarget/geometry/pinhole.hpp"
#include "retarget/math/types.hpp"

namespace understudy::render {

using Mat4 = Eigen::Matrix4f;

struct PixelSize {
  int width = 0, height = 0;
  float aspect() const { return static_cast<float>(width) / static_cast<float>(height); }
};
template <class V, class S>
FieldsOf<S, PixelSize> fields(V& visit, S& size) {
  unnamed(visit, size.width, size.height);
}

struct Camera {
  Vec3 target = Vec3(0, 0.9f, 0);  ///< metres; the point it looks at and turns about
  float yaw = 0;        ///< radians about +y; 0 looks along -z, at the front of a T-pose; +90 deg from +x
  float pitch = 0.15f;  ///< radians above the horizon
  float distance = 4;   ///< metres from the target
  float fov = 0.5f;     ///< vertical, radians
  bool orthographic = false;  ///< shows as much as the perspective does at the target's distance
};
template <class V, class S>
FieldsOf<S, Camera> fields(V& visit, S& c) {
  unnamed(visit, c.target, c.yaw, c.pitch, c.distance, c.fov, c.orthographic);
}

/// The same as a projection; pixels from the picture's top left corner, so that the middle of the first one
/// is at 0.5, 0.5. Files of 2D poses count from that middle: theirs is half a pixel less.
Pinhole pinhole(const Camera& camera, PixelSize size);
/// The camera's axes in the world as columns: right, up, back (towards the viewer).
Mat3 axes(const Camera& camera);
Vec3 eye(const Camera& camera);
/// World to camera.
Mat4 view_matrix(const Camera& camera);
/// Camera to clip space (OpenGL's, z in -1..1); aspect is width / height.
Mat4 projection_matrix(const Camera& camera, float aspect);
/// The ray through a place in the picture, x and y in -1..1 (y up).
struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< unit length
};
Ray ray_through(const Camera& camera, float aspect, const Eigen::Vector2f& place);

/// The ray through a pixel, x right and y down from the picture's top left corner.
Ray ray_through(const Camera& camera, PixelSize size, const Eigen::Vector2f& pixel);
/// Where a point is seen: x and y in pixels from the top left, z metres before the eye (before the camera's
/// target plane when orthographic: negative is nearer). Behind the eye z is negative and x, y mean nothing.
Vec3 on_screen(const Camera& camera, PixelSize size, const Vec3& point);
/// How many metres a pixel covers at a point.
float metres_a_pixel(const Camera& camera, PixelSize size, const Vec3& point);

/// Turned about its target; the pitch stops short of the poles.
Camera orbited(Camera camera, float yaw, float pitch);
/// Moved with its target by a share of the picture's height, so that the scene follows the pointer.
Camera panned(Camera camera, const Eigen::Vector2f& share_of_height);
/// Distance times `factor`, kept between 5 cm and 500 m.
Camera zoomed(Camera camera, float factor);

/// The camera moved, with its direction and lens kept, so that it sees all points as large as possible.
/// `margin` is the share of the picture left free on each side. No points: the camera unchanged.
Camera fitted(Camera camera, const Points& points, float aspect, float margin = 0.05f);
/// The least distance from which all points are seen with the target where it is. Perspective and
/// orthographic.
float fitting_distance(const Camera& camera, const Points& points, float aspect, float margin = 0.05f);

}  // namespace understudy::render
