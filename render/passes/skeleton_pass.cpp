#include "render/passes/skeleton_pass.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "render/colors.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

constexpr int kAround = 12;            // corners of a ring
constexpr float kBallRadius = 0.021f;  // metres, at thickness 1
constexpr float kBoneRadius = 0.026f;  // at a bone's thickest

/// Rings of vertices stacked along an axis, closed by triangles: bones and balls alike.
class SolidBuilder {
 public:
  struct Ring {
    Vec3 center;
    float radius;
    float slope;  // of the normal along the axis: 0 straight out, > 0 towards the axis's end
  };

  void add(const std::vector<Ring>& rings, const Vec3& axis, const Vec3& color) {
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    for (size_t r = 0; r < rings.size(); ++r)
      for (int k = 0; k < kAround; ++k) {
        const float angle = 2 * kPi * static_cast<float>(k) / kAround;
        const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
        positions_.push_back(rings[r].center + rings[r].radius * out);
        normals_.push_back((out + rings[r].slope * axis).normalized());
        colors_.push_back(color);
        if (r > 0) add_quad(k);
      }
  }

  MeshView mesh() const {
    MeshView view;
    const auto rows = [](const std::vector<Vec3>& from) {
      Points to(static_cast<Eigen::Index>(from.size()), 3);
      for (size_t i = 0; i < from.size(); ++i) to.row(static_cast<Eigen::Index>(i)) = from[i];
      return to;
    };
    view.vertices = rows(positions_);
    view.normals = rows(normals_);
    view.colors = rows(colors_);
    Faces faces(static_cast<Eigen::Index>(faces_.size()), 3);
    for (size_t f = 0; f < faces_.size(); ++f) faces.row(static_cast<Eigen::Index>(f)) = faces_[f];
    view.faces = std::move(faces);
    view.two_sided = false;
    return view;
  }

 private:
  /// The two triangles from corner k of the newest ring to the next corner and the ring before.
  void add_quad(int k) {
    const int start = static_cast<int>(positions_.size()) - 1 - k;  // of the newest ring
    const int a = start + k, b = start + (k + 1) % kAround;
    faces_.emplace_back(a, a - kAround, b - kAround);
    faces_.emplace_back(a, b - kAround, b);
  }

  std::vector<Vec3> positions_, normals_, colors_;
  std::vector<Eigen::RowVector3i> faces_;
};

void add_ball(SolidBuilder& solids, const Vec3& center, float radius, const Vec3& color) {
  constexpr int kRings = 8;
  std::vector<SolidBuilder::Ring> rings;
  for (int i = 0; i <= kRings; ++i) {
    const float angle = kPi * (static_cast<float>(i) / kRings - 0.5f);  // from the south pole up
    const float slope = std::tan(std::clamp(angle, -1.5f, 1.5f));
    rings.push_back({center + radius * std::sin(angle) * Vec3::UnitY(), radius * std::cos(angle), slope});
  }
  solids.add(rings, Vec3::UnitY(), color);
}

/// Thin at both ends, thickest a sixth of the way from the parent, so that it shows which way it points.
void add_bone(SolidBuilder& solids, const Vec3& from, const Vec3& to, float thickness, const Vec3& color) {
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
  return side == Side::Left ? kLeftColor : side == Side::Right ? kRightColor : kMiddleColor;
}

void check(const SkeletonView& view) {
  const size_t joints = static_cast<size_t>(view.joints.rows());
  US_CHECK(view.parents.size() == joints, "a skeleton of ", joints, " joints has ", view.parents.size(),
           " parents");
  US_CHECK(view.sides.empty() || view.sides.size() == joints, "a skeleton of ", joints, " joints has ",
           view.sides.size(), " sides");
  for (int parent : view.parents)
    US_CHECK(parent >= -1 && parent < static_cast<int>(joints), "a skeleton of ", joints,
             " joints has a parent ", parent);
}

}  // namespace

MeshView skeleton_solids(const SkeletonView& view) {
  check(view);
  SolidBuilder solids;
  for (size_t j = 0; j < view.parents.size(); ++j) {
    const Vec3 here = view.joints.row(static_cast<Eigen::Index>(j));
    if (!here.allFinite()) continue;
    const Vec3 color = color_of(view, j);
    add_ball(solids, here, kBallRadius * view.thickness, color);
    if (view.parents[j] < 0) continue;
    const Vec3 parent = view.joints.row(view.parents[j]);
    if (parent.allFinite()) add_bone(solids, parent, here, view.thickness, color);
  }
  return solids.mesh();
}

}  // namespace understudy::render
