#include "ui/viewport/navigation.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace understudy::ui {
namespace {

constexpr float kTurn = 0.0075f;  // radians a point of dragging
constexpr float kNotch = 0.88f;   // of the distance, a notch of the wheel

/// Where a ray meets the plane through the target that faces the camera.
Vec3 on_target_plane(const render::Camera& camera, const render::Ray& ray) {
  const Vec3 back = render::axes(camera).col(2);
  const float along = (camera.target - ray.origin).dot(back) / ray.direction.dot(back);
  return ray.origin + along * ray.direction;
}

}  // namespace

Pointer pointer_of_item() {
  const ImGuiIO& io = ImGui::GetIO();
  Pointer pointer;
  pointer.at = io.MousePos, pointer.moved = io.MouseDelta;
  pointer.over = ImGui::IsItemHovered();
  const bool active = ImGui::IsItemActive();
  pointer.wheel = pointer.over ? io.MouseWheel : 0;
  pointer.pressed = ImGui::IsItemActivated() && ImGui::IsMouseClicked(0);
  pointer.held = active && ImGui::IsMouseDown(0);
  pointer.released = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(0);
  pointer.doubled = pointer.over && ImGui::IsMouseDoubleClicked(0);
  pointer.turning = active && ImGui::IsMouseDown(1);
  pointer.panning = active && (ImGui::IsMouseDown(2) || (ImGui::IsMouseDown(0) && io.KeyShift));
  return pointer;
}

render::Camera orbit_drag(const render::Camera& camera, const ImVec2& moved,
                          const NavigationOptions& options) {
  const float turn = kTurn * options.sensitivity / options.scale;
  return render::orbited(camera, -turn * moved.x, turn * moved.y);
}

render::Camera pan_drag(const PaneView& view, const ImVec2& moved) {
  const float height = view.rect.height();
  return render::panned(view.camera, {moved.x / height, -moved.y / height});
}

render::Camera wheel_zoom(const PaneView& view, const ImVec2& at, float notches) {
  const render::Camera camera = render::zoomed(view.camera, std::pow(kNotch, notches));
  const float factor = camera.distance / view.camera.distance;
  const Vec3 under = on_target_plane(view.camera, view.ray(at));
  render::Camera moved = camera;
  moved.target = under + factor * (view.camera.target - under);
  return moved;
}

std::optional<render::Camera> navigated(const PaneView& view, const Pointer& pointer, bool free_left,
                                        const NavigationOptions& options) {
  const bool still = pointer.moved.x == 0 && pointer.moved.y == 0;
  if (pointer.wheel != 0) return wheel_zoom(view, pointer.at, pointer.wheel);
  if (still) return std::nullopt;
  if (pointer.panning) return pan_drag(view, pointer.moved);
  if (pointer.turning || (pointer.held && free_left && !pointer.pressed))
    return orbit_drag(view.camera, pointer.moved, options);
  return std::nullopt;
}

}  // namespace understudy::ui
