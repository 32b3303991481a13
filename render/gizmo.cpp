#include "render/gizmo.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/solids.hpp"

namespace understudy::render {
namespace {

// Shares of the reach.
constexpr float kThick = 0.028f, kPlateFrom = 0.28f, kPlateTo = 0.52f, kCentre = 0.09f, kNear = 0.075f;

const Vec3 kAxisColors[3] = {{0.86f, 0.24f, 0.22f}, {0.40f, 0.68f, 0.16f}, {0.18f, 0.45f, 0.88f}};
const Vec3 kHovered(1.0f, 0.82f, 0.20f), kCentreColor(0.92f, 0.93f, 0.95f);

Vec3 color_of(const GizmoView& gizmo, GizmoHandle handle, const Vec3& usual) {
  return gizmo.hovered == handle ? kHovered : usual;
}

GizmoHandle handle_of(GizmoHandle first, int axis) {
  return static_cast<GizmoHandle>(static_cast<int>(first) + axis);
}
/// 0..2 of an axis or of a plane's normal; -1 for the others.
int axis_of(GizmoHandle handle) {
  if (handle >= GizmoHandle::AxisX && handle <= GizmoHandle::AxisZ)
    return static_cast<int>(handle) - static_cast<int>(GizmoHandle::AxisX);
  if (handle >= GizmoHandle::PlaneYz && handle <= GizmoHandle::PlaneXy)
    return static_cast<int>(handle) - static_cast<int>(GizmoHandle::PlaneYz);
  return -1;
}

/// The place along a line through `origin` that comes nearest to the ray; NaN when they are parallel.
float nearest_along(const Vec3& origin, const Vec3& axis, const Ray& ray) {
  const Vec3 between = ray.origin - origin;
  const float b = axis.dot(ray.direction), d = axis.dot(between), e = ray.direction.dot(between);
  const float denominator = 1 - b * b;
  if (denominator < 1e-4f) return std::numeric_limits<float>::quiet_NaN();
  return (d - b * e) / denominator;
}

/// Where the ray meets a plane; NaN when it runs along it.
Vec3 meeting(const Vec3& origin, const Vec3& normal, const Ray& ray) {
  const float slope = normal.dot(ray.direction);
  if (std::abs(slope) < 1e-3f) return Vec3::Constant(std::numeric_limits<float>::quiet_NaN());
  return ray.origin + normal.dot(origin - ray.origin) / slope * ray.direction;
}

float distance_to(const Ray& ray, const Vec3& point) {
  return (point - ray.origin).cross(ray.direction).norm();
}

/// What the pointer has found so far.
struct Found {
  GizmoHandle handle = GizmoHandle::None;
  float depth = std::numeric_limits<float>::infinity();
  void offer(GizmoHandle which, const Ray& ray, const Vec3& at) {
    const float here = ray.direction.dot(at - ray.origin);
    if (here < depth) handle = which, depth = here;
  }
};

void look_for_arrow(Found& found, const GizmoView& gizmo, float reach, int axis, const Ray& ray) {
  const Vec3 along = gizmo.axes.col(axis);
  const float t = nearest_along(gizmo.position, along, ray);
  if (!(t > 0.15f * reach && t < 1.05f * reach)) return;
  const Vec3 at = gizmo.position + t * along;
  if (distance_to(ray, at) < kNear * reach) found.offer(handle_of(GizmoHandle::AxisX, axis), ray, at);
}

void look_for_plate(Found& found, const GizmoView& gizmo, float reach, int axis, const Ray& ray) {
  const Vec3 at = meeting(gizmo.position, gizmo.axes.col(axis), ray);
  const float u = gizmo.axes.col((axis + 1) % 3).dot(at - gizmo.position) / reach;
  const float v = gizmo.axes.col((axis + 2) % 3).dot(at - gizmo.position) / reach;
  if (u > kPlateFrom && u < kPlateTo && v > kPlateFrom && v < kPlateTo)
    found.offer(handle_of(GizmoHandle::PlaneYz, axis), ray, at);
}

/// The ring is looked at along its whole length, as the ray may meet its plane edge-on.
void look_for_ring(Found& found, const GizmoView& gizmo, float reach, int axis, const Ray& ray) {
  constexpr int kSteps = 96;
  const Vec3 u = gizmo.axes.col((axis + 1) % 3), v = gizmo.axes.col((axis + 2) % 3);
  for (int i = 0; i < kSteps; ++i) {
    const float angle = 2 * kPi * static_cast<float>(i) / kSteps;
    const Vec3 at = gizmo.position + reach * (std::cos(angle) * u + std::sin(angle) * v);
    if (distance_to(ray, at) < 0.7f * kNear * reach)
      found.offer(handle_of(GizmoHandle::AxisX, axis), ray, at);
  }
}

/// Those that there is something to grip of.
int axes_of(const GizmoView& gizmo) {
  return gizmo.kind == GizmoView::Kind::Turn ? gizmo.rings : 3;
}

}  // namespace

float gizmo_reach(const GizmoView& gizmo, const Camera& camera) {
  const float away = camera.orthographic
                         ? camera.distance
                         : std::max(0.01f, (eye(camera) - gizmo.position).dot(axes(camera).col(2)));
  return gizmo.size * 2 * away * std::tan(camera.fov / 2);
}

GizmoHandle handle_under(const GizmoView& gizmo, const Camera& camera, const Ray& pointer) {
  const float reach = gizmo_reach(gizmo, camera);
  if (gizmo.kind == GizmoView::Kind::Move && distance_to(pointer, gizmo.position) < 1.2f * kCentre * reach)
    return GizmoHandle::Centre;
  Found found;
  for (int axis = 0; axis < axes_of(gizmo); ++axis) {
    if (gizmo.kind == GizmoView::Kind::Turn) {
      look_for_ring(found, gizmo, reach, axis, pointer);
    } else {
      look_for_arrow(found, gizmo, reach, axis, pointer);
      look_for_plate(found, gizmo, reach, axis, pointer);
    }
  }
  return found.handle;
}

Vec3 dragged(const GizmoView& gizmo, GizmoHandle handle, const Camera& camera, const Ray& from,
             const Ray& to) {
  Vec3 moved = Vec3::Zero();
  if (handle >= GizmoHandle::AxisX && handle <= GizmoHandle::AxisZ) {
    const Vec3 along = gizmo.axes.col(axis_of(handle));
    moved = (nearest_along(gizmo.position, along, to) - nearest_along(gizmo.position, along, from)) * along;
  } else if (handle != GizmoHandle::None) {
    const Vec3 normal =
        handle == GizmoHandle::Centre ? Vec3(axes(camera).col(2)) : Vec3(gizmo.axes.col(axis_of(handle)));
    moved = meeting(gizmo.position, normal, to) - meeting(gizmo.position, normal, from);
  }
  return moved.allFinite() ? moved : Vec3::Zero();
}

float turned(const GizmoView& gizmo, GizmoHandle handle, const Camera& camera, const Ray& from,
             const Ray& to) {
  if (handle < GizmoHandle::AxisX || handle > GizmoHandle::AxisZ) return 0;
  const Vec3 axis = gizmo.axes.col(axis_of(handle));
  const float facing = axis.dot(axes(camera).col(2));
  if (std::abs(facing) < 0.1f) {  // the ring is seen from its edge: a drag across the axis rolls it
    const Vec3 across = axis.cross(axes(camera).col(2)).normalized();
    const Vec3 moved = dragged(gizmo, GizmoHandle::Centre, camera, from, to);
    return std::clamp(moved.dot(across) / std::max(1e-6f, gizmo_reach(gizmo, camera)), -kPi, kPi);
  }
  const Vec3 a = meeting(gizmo.position, axis, from) - gizmo.position;
  const Vec3 b = meeting(gizmo.position, axis, to) - gizmo.position;
  const float angle = std::atan2(axis.dot(a.cross(b)), a.dot(b));
  return std::isfinite(angle) ? angle : 0.f;
}

MeshView gizmo_solids(const GizmoView& gizmo, const Camera& camera) {
  const float reach = gizmo_reach(gizmo, camera);
  Solids solids;
  for (int axis = 0; axis < axes_of(gizmo); ++axis) {
    const GizmoHandle handle = handle_of(GizmoHandle::AxisX, axis),
                      plane = handle_of(GizmoHandle::PlaneYz, axis);
    const Vec3 along = reach * gizmo.axes.col(axis), color = color_of(gizmo, handle, kAxisColors[axis]);
    if (gizmo.kind == GizmoView::Kind::Turn) {
      solids.add_torus(gizmo.position, gizmo.axes.col(axis), reach, kThick * reach, color);
      continue;
    }
    solids.add_arrow(gizmo.position + 0.15f * along, gizmo.position + along, kThick * reach, color);
    const Vec3 u = reach * gizmo.axes.col((axis + 1) % 3), v = reach * gizmo.axes.col((axis + 2) % 3);
    solids.add_plate(gizmo.position + kPlateFrom * (u + v), (kPlateTo - kPlateFrom) * u,
                     (kPlateTo - kPlateFrom) * v,
                     color_of(gizmo, plane, 0.75f * kAxisColors[axis] + Vec3::Constant(0.2f)));
  }
  if (gizmo.kind == GizmoView::Kind::Move)
    solids.add_ball(gizmo.position, kCentre * reach, color_of(gizmo, GizmoHandle::Centre, kCentreColor));
  return solids.mesh();
}

}  // namespace understudy::render
