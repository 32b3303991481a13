#include "render/passes/skeleton_pass.hpp"

#include <algorithm>

#include "render/colors.hpp"
#include "render/solids.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

constexpr float kBallRadius = 0.021f;  // metres, at thickness 1
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
    solids.add_ball(here, kBallRadius * view.thickness, color);
    if (view.parents[j] < 0) continue;
    const Vec3 parent = view.joints.row(view.parents[j]);
    if (parent.allFinite()) add_bone(solids, parent, here, view.thickness, color);
  }
  return solids.mesh();
}

}  // namespace understudy::render
