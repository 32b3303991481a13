#include "app/session/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace understudy::app {

float aspect_of_a_view(const View& view, size_t takes) {
  constexpr float kAllViews = 1.55f;  // side by side
  return view.layout == Layout::SideBySide ? kAllViews / static_cast<float>(1 + takes) : kAllViews;
}

float distance_to_see(const CameraState& camera, float aspect, const Vec3& low, const Vec3& high) {
  constexpr float kAir = 1.08f;
  const Vec3 right(std::cos(camera.yaw), 0, -std::sin(camera.yaw));
  const Vec3 back(std::sin(camera.yaw) * std::cos(camera.pitch), std::sin(camera.pitch),
                  std::cos(camera.yaw) * std::cos(camera.pitch));
  const Vec3 up = back.cross(right);
  const float rise = std::tan(0.5f * camera.fov), run = rise * aspect;
  float least = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 at = -camera.target;  // of the corner, from the target
    for (int k = 0; k < 3; ++k) at[k] += (corner >> k & 1) != 0 ? high[k] : low[k];
    const float nearer = camera.orthographic ? 0 : at.dot(back);
    const float high_up = std::abs(at.dot(up)) / rise, far_out = std::abs(at.dot(right)) / run;
    least = std::max(least, nearer + kAir * std::max(high_up, far_out));
  }
  return least;
}

}  // namespace understudy::app
