// Handles to move or turn something: their shape, which one is under the pointer, and what a drag does.
#pragma once

#include "render/camera.hpp"
#include "render/scene.hpp"

namespace understudy::render {

/// The gizmo's size: metres from its middle to an arrow's tip (a ring's radius), so that it looks equally
/// large from everywhere.
float gizmo_reach(const GizmoView& gizmo, const Camera& camera);

/// The handle that the pointer's ray goes through or passes closely; None when there is none. The nearest to
/// the eye wins.
GizmoHandle handle_under(const GizmoView& gizmo, const Camera& camera, const Ray& pointer);

/// How far a drag from one ray to another moves along the handle's axis or in its plane, metres in the world;
/// zero for None and where the rays run along the axis or plane. Centre: in the plane that faces the camera.
Vec3 dragged(const GizmoView& gizmo, GizmoHandle handle, const Camera& camera, const Ray& from,
             const Ray& to);
/// How far it turns about the handle's axis (AxisX .. AxisZ), radians, right-handed, -pi..pi.
float turned(const GizmoView& gizmo, GizmoHandle handle, const Camera& camera, const Ray& from,
             const Ray& to);

/// The handles as a lit mesh in the world.
MeshView gizmo_solids(const GizmoView& gizmo, const Camera& camera);

}  // namespace understudy::render
