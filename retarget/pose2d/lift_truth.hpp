// What lifting should find of a simulated person.
#pragma once

#include "retarget/geometry/pinhole.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// A body as a camera sees it that was turned to look at the middle of its hips: where somebody stands in the
/// picture changes nothing.
struct LiftTruth {
  Joints joints = Joints::Zero();          ///< around the middle of the hips; right, up, to the eye; metres
  Rotations turns = identity_rotations();  ///< of the joints' frames, in the same axes
  float pixels_a_metre = 1;                ///< across the view at the middle of the hips
};
LiftTruth lift_truth(const PosedSkeleton& posed, const Pinhole& camera);

/// Turns from the axes of a camera that looks at something to those of one that sees it in the direction
/// `way` (right, up, back), which points from it to the eye.
Mat3 turn_from_middle(const Vec3& way);
/// The middle of both hips, metres.
Vec3 hips_middle(const Joints& joints);

}  // namespace understudy
