// How rigid parts hang together: joints, their kinds, and the tree.
#pragma once

#include <vector>

#include "retarget/discovery/rigid_parts.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// What two parts that touch have in common.
struct PartJoint {
  JointKind kind = JointKind::Ball;
  Vec3 rest = Vec3::Zero();   ///< the place that both carry alike, at rest, metres
  Vec3 axis = Vec3::UnitY();  ///< of a hinge or slider, at rest
  float off_m = 0;            ///< how far apart both carry it, root of the mean square over the frames
};
/// The joint of two bodies that move so, [T] each, which touch at `seam`: the place c that minimises
/// sum_t |A_t c - B_t c|^2, held near the seam where the motion does not tell (along a hinge's axis).
/// noise_m: of the motions; size_m: of the whole body. Chang and Zwicker 2011, section 5.
PartJoint find_joint(const std::vector<RigidMotion>& parent, const std::vector<RigidMotion>& child,
                     const Vec3& seam, float noise_m, float size_m);

/// Whether a part of a body of that size does not move, as at `at`.
bool stands_still(const std::vector<RigidMotion>& motions, const Vec3& at, float size_m);

/// A rig without a surface, and which part each of its bones is.
struct PartTree {
  Rig rig;
  std::vector<int> part_of_bone;
};
/// The tree of least cost: joints that both sides carry alike, at their seam. The root is what stands still,
/// else the part from which the others are fewest steps away, weighted by their size. Parts that hardly
/// move against each other become one: `parts` then has fewer.
PartTree find_part_tree(const SurfaceTracks& tracks, RigidParts& parts);

}  // namespace understudy
