#include "app/stimuli/moving_surface.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/geometry/cloud_normals.hpp"

namespace understudy::app {

size_t MovingSurface::index_at(double seconds) const {
  const double last = static_cast<double>(frames.size()) - 1;
  return static_cast<size_t>(std::clamp(std::round(seconds * fps), 0.0, last));
}

namespace {

Mesh finite_part(const Mesh& mesh) {
  if (mesh.vertices.allFinite()) return mesh;
  std::vector<char> kept(static_cast<size_t>(mesh.vertices.rows()));
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
    kept[static_cast<size_t>(v)] = mesh.vertices.row(v).allFinite() ? 1 : 0;
  return kept_part(mesh, kept);
}

}  // namespace

SurfaceFrame surface_frame(const Mesh& whole) {
  const Mesh mesh = finite_part(whole);
  SurfaceFrame frame;
  frame.vertices = mesh.vertices;
  frame.faces = mesh.faces;
  frame.colors = mesh.colors;
  if (!mesh.is_cloud()) return frame;
  frame.spacing = point_spacing(mesh.vertices);
  frame.normals = estimated_normals(mesh.vertices);
  return frame;
}

Points seen_points(const SurfaceFrame& frame) {
  return finite_points(frame.skeleton ? Points(*frame.skeleton) : *frame.vertices);
}

void add(render::Scene& scene, const MovingSurface& surface, const SurfaceFrame& frame) {
  constexpr float kDisc = 1.15f;  // against the spacing: few holes, edges still sharp
  if (frame.skeleton) {
    scene.skeletons.push_back(render::skeleton_view(*frame.skeleton));
    return;
  }
  if (frame.faces->rows() == 0) {
    render::PointsView view;
    view.positions = frame.vertices, view.normals = frame.normals;
    view.colors = frame.colors, view.color = surface.color;
    if (frame.spacing > 0) view.radius = kDisc * frame.spacing;
    scene.clouds.push_back(std::move(view));
    return;
  }
  render::MeshView view;
  view.vertices = frame.vertices, view.faces = frame.faces;
  view.colors = frame.colors, view.color = surface.color;
  if (surface.ambient->rows() == frame.vertices->rows()) view.ambient = surface.ambient;
  view.two_sided = !surface.closed;
  scene.meshes.push_back(std::move(view));
}

}  // namespace understudy::app
