#include "ui/viewport/same_picture.hpp"

#include <algorithm>
#include <tuple>

namespace understudy::ui {
namespace {

using render::Scene;

/// Arrays of any size.
template <class Array>
bool equal(const Array& a, const Array& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a.size() == 0 || (a.array() == b.array()).all());
}

bool same(const render::MeshView& a, const render::MeshView& b) {
  const auto key = [](const render::MeshView& m) {
    return std::make_tuple(m.vertices.identity(), m.faces.identity(), m.normals.identity(),
                           m.colors.identity(), m.ambient.identity(), m.opacity, m.two_sided);
  };
  return key(a) == key(b) && a.color == b.color;
}

bool same(const render::PointsView& a, const render::PointsView& b) {
  const auto key = [](const render::PointsView& p) {
    return std::make_tuple(p.normals.identity(), p.radius);
  };
  // Small ones (handles) are made anew each time.
  const auto alike = [](const render::SharedPoints& x, const render::SharedPoints& y) {
    return x.identity() == y.identity() || (x->rows() <= 64 && equal(*x, *y));
  };
  return key(a) == key(b) && a.color == b.color && alike(a.positions, b.positions) &&
         alike(a.colors, b.colors);
}

bool same(const render::SkeletonView& a, const render::SkeletonView& b) {
  return equal(a.joints, b.joints) && a.parents == b.parents && a.sides == b.sides &&
         a.thickness == b.thickness && a.x_ray == b.x_ray && a.tint == b.tint && a.tint_share == b.tint_share;
}

bool same(const render::LinesView& a, const render::LinesView& b) {
  return equal(a.positions, b.positions) && equal(a.colors, b.colors) && equal(a.opacities, b.opacities) &&
         a.color == b.color && a.connected == b.connected && a.opacity == b.opacity && a.width == b.width &&
         a.x_ray == b.x_ray;
}

bool same(const render::GizmoView& a, const render::GizmoView& b) {
  return a.kind == b.kind && a.position == b.position && a.axes == b.axes && a.size == b.size &&
         a.hovered == b.hovered;
}

bool same(const render::GroundView& a, const render::GroundView& b) {
  return std::tie(a.visible, a.height, a.spacing, a.radius, a.shadow) ==
             std::tie(b.visible, b.height, b.spacing, b.radius, b.shadow) &&
         a.line == b.line;
}

bool same(const render::LightView& a, const render::LightView& b) {
  return a.key_direction == b.key_direction && a.fill_direction == b.fill_direction && a.key == b.key &&
         a.fill == b.fill && a.sky == b.sky && a.floor == b.floor && a.shine == b.shine;
}

bool same(const render::BackgroundView& a, const render::BackgroundView& b) {
  return a.top == b.top && a.bottom == b.bottom && a.transparent == b.transparent;
}

template <class View>
bool same(const std::vector<View>& a, const std::vector<View>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const View& x, const View& y) { return same(x, y); });
}

}  // namespace

bool same_picture(const Scene& a, const Scene& b) {
  return same(a.meshes, b.meshes) && same(a.clouds, b.clouds) && same(a.skeletons, b.skeletons) &&
         same(a.lines, b.lines) && same(a.gizmos, b.gizmos) && same(a.ground, b.ground) &&
         same(a.light, b.light) && same(a.background, b.background) && a.occlusion == b.occlusion;
}

bool same_picture(const render::Camera& a, const render::Camera& b) {
  return a.target == b.target && std::tie(a.yaw, a.pitch, a.distance, a.fov, a.orthographic) ==
                                     std::tie(b.yaw, b.pitch, b.distance, b.fov, b.orthographic);
}

}  // namespace understudy::ui
