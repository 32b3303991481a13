// From the pose a character stands in (A-pose, or anything upright) to the T-pose that the networks know, and
// back.
#pragma once

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The vector from one joint to another, metres.
Vec3 bone(const Joints& joints, int from, int to);

/// How the joints of a bind pose turn to the T-pose.
struct RestPose {
  Joints bind = Joints::Zero();              ///< as the character came, metres, y up, facing +z
  Joints rest = Joints::Zero();              ///< in T-pose; the pelvis stays
  Rotations to_rest = identity_rotations();  ///< world rotation of each joint from the one to the other
  float largest_deg = 0;                     ///< of them
  /// The pose, relative to the T-pose, in which the character came.
  Pose back() const;
};

/// Limbs get the directions of the mean human's T-pose, which motion transfer takes for granted: legs that
/// stand a few degrees closer would cross. Feet and trunk stay as they are, and so do limbs within the
/// tolerance. Bone lengths stay.
RestPose to_t_pose(const Joints& bind, float tolerance_deg = 1);

/// Turns both legs about the hips, alike, until they stand apart as a mean human's. For joints that were
/// seen, not given: single bones are rough, both legs together are not.
void spread_legs(RestPose& pose, float tolerance_deg);

/// The same turns for joints that lie elsewhere.
RestPose with_joints(RestPose pose, const Joints& bind);

/// The surface in T-pose: linear blend skinning by `weights` [V, 22].
Points in_t_pose(const Points& vertices, const RowMatrix& weights, const RestPose& pose);

/// Where joints face, radians about +y from +z towards +x: across hips and shoulders.
float heading_of_joints(const Joints& joints);

}  // namespace understudy
