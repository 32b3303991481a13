#include "render/solids.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/colors.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

constexpr int kAround = 12;  // corners of a ring

Points rows(const std::vector<Vec3>& from) {
  Points to(from.size(), 3);
  for (size_t i = 0; i < from.size(); ++i) to.row(i) = from[i];
  return to;
}

}  // namespace

int Solids::add_vertex(const Vec3& position, const Vec3& normal, const Vec3& color) {
  positions_.push_back(position);
  normals_.push_back(normal);
  colors_.push_back(color);
  return positions_.size() - 1;
}

/// Joins two circles of vertices, the second further along the axis.
void Solids::add_quads(int first, int second, int around) {
  for (int k = 0; k < around; ++k) {
    const int a = second + k, b = second + (k + 1) % around, c = first + k, d = first + (k + 1) % around;
    faces_.emplace_back(a, c, d);
    faces_.emplace_back(a, d, b);
  }
}

void Solids::add(const std::vector<Ring>& rings, const Vec3& axis, const Vec3& color) {
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  int before = -1;
  for (const Ring& ring : rings) {
    const int first = positions_.size();
    for (int k = 0; k < kAround; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / kAround;
      const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
      add_vertex(ring.center + ring.radius * out, (out + ring.slope * axis).normalized(), color);
    }
    if (before >= 0) add_quads(before, first, kAround);
    before = first;
  }
}

void Solids::add_ball(const Vec3& center, float radius, const Vec3& color) {
  constexpr int kRings = 8;
  std::vector<Ring> rings;
  for (int i = 0; i <= kRings; ++i) {
    const float angle = kPi * (static_cast<float>(i) / kRings - 0.5f);  // from the south pole up
    const float slope = std::tan(std::clamp(angle, -1.5f, 1.5f));
    rings.push_back({center + radius * std::sin(angle) * Vec3::UnitY(), radius * std::cos(angle), slope});
  }
  add(rings, Vec3::UnitY(), color);
}

void Solids::add_arrow(const Vec3& from, const Vec3& to, float thickness, const Vec3& color) {
  const float length = (to - from).norm();
  if (length < 1e-6f) return;
  const Vec3 axis = (to - from) / length, neck = to - axis * std::min(0.5f * length, 5 * thickness);
  add({{from, 0, -20}, {from, thickness, -20}}, axis, color);
  add({{from, thickness, 0}, {neck, thickness, 0}}, axis, color);
  add({{neck, thickness, -20}, {neck, 2.4f * thickness, -20}}, axis, color);
  add({{neck, 2.4f * thickness, 0.5f}, {to, 0, 0.5f}}, axis, color);
}

void Solids::add_torus(const Vec3& center, const Vec3& axis, float radius, float thickness,
                       const Vec3& color) {
  constexpr int kLong = 64, kSection = 8;
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<int> circles;
  for (int i = 0; i < kLong; ++i) {
    const float angle = 2 * kPi * static_cast<float>(i) / kLong;
    const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
    circles.push_back(positions_.size());
    for (int k = 0; k < kSection; ++k) {
      const float turn = 2 * kPi * static_cast<float>(k) / kSection;
      const Vec3 normal = std::cos(turn) * out - std::sin(turn) * axis;
      add_vertex(center + radius * out + thickness * normal, normal, color);
    }
  }
  for (size_t i = 0; i < circles.size(); ++i)
    add_quads(circles[i], circles[(i + 1) % circles.size()], kSection);
}

void Solids::add_plate(const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& color) {
  const Vec3 normal = u.cross(v).normalized();
  for (const float side : {1.f, -1.f}) {
    const int a = add_vertex(corner, side * normal, color), b = add_vertex(corner + u, side * normal, color);
    const int c = add_vertex(corner + u + v, side * normal, color);
    const int d = add_vertex(corner + v, side * normal, color);
    faces_.emplace_back(a, side > 0 ? b : c, side > 0 ? c : b);
    faces_.emplace_back(a, side > 0 ? c : d, side > 0 ? d : c);
  }
}

MeshView Solids::mesh() const {
  MeshView view;
  view.vertices = rows(positions_);
  view.normals = rows(normals_);
  view.colors = rows(colors_);
  Faces faces(faces_.size(), 3);
  for (size_t f = 0; f < faces_.size(); ++f) faces.row(f) = faces_[f];
  view.faces = std::move(faces);
  view.two_sided = false;
  return view;
}

namespace {

constexpr float kBallRadius = 0.021f;  // metres, at thickness 1
constexpr float kMarkRadius = 0.038f;  // of balls in colours of their own
constexpr float kBoneRadius = 0.026f;  // at a bone's thickest

/// Thin at both ends, thickest a sixth of the way from the parent, so that it shows which way it points.
void add_bone(Solids& solids, const Vec3& from, const Vec3& to, float thickness, const Vec3& color) {
  const Vec3 along = to - from;
  const float length = along.norm();
  if (length < 1e-4f) return;
  const float thick = std::min(kBoneRadius * thickness, 0.22f * length), thin = 0.30f * thick;
  const float bulge = length / 6;
  const float up = -(thick - thin) / bulge, down = (thick - thin) / (length - bulge);
  solids.add({{from, thin, up},
              {from + along / 6 * 0.8f, 0.94f * thick, 0.5f * up},
              {from + along / 6, thick, 0},
              {from + along / 6 * 1.4f, 0.97f * thick, down},
              {to, thin, down}},
             along / length, color);
}

Vec3 color_of(const SkeletonView& view, size_t joint) {
  const Side side = view.sides.empty() ? Side::Middle : view.sides[joint];
  const Vec3& own = side == Side::Left ? kLeftColor : side == Side::Right ? kRightColor : kMiddleColor;
  return (1 - view.tint_share) * own + view.tint_share * view.tint;
}

void check(const SkeletonView& view) {
  const size_t joints = view.joints.rows();
  US_CHECK(view.parents.size() == joints, "a skeleton of ", joints, " joints has ", view.parents.size(),
           " parents");
  US_CHECK(view.sides.empty() || view.sides.size() == joints, "a skeleton of ", joints, " joints has ",
           view.sides.size(), " sides");
  US_CHECK(view.colors.rows() == 0 || view.colors.rows() == view.joints.rows(), "a skeleton of ", joints,
           " joints has ", view.colors.rows(), " colours");
  for (int parent : view.parents)
    US_CHECK(parent >= -1 && parent < static_cast<int>(joints), "a skeleton of ", joints,
             " joints has a parent ", parent);
}

}  // namespace

MeshView skeleton_solids(const SkeletonView& view) {
  check(view);
  Solids solids;
  for (size_t j = 0; j < view.parents.size(); ++j) {
    const Vec3 here = view.joints.row(j);
    if (!here.allFinite()) continue;
    const Vec3 color = color_of(view, j);
    if (view.colors.rows() == 0)
      solids.add_ball(here, kBallRadius * view.thickness, color);
    else
      solids.add_ball(here, kMarkRadius * view.thickness, view.colors.row(static_cast<Eigen::Index>(j)));
    if (view.parents[j] < 0) continue;
    const Vec3 parent = view.joints.row(view.parents[j]);
    if (parent.allFinite()) add_bone(solids, parent, here, view.thickness, color);
  }
  MeshView mesh = solids.mesh();
  mesh.opacity = view.opacity;
  return mesh;
}

}  // namespace understudy::render
