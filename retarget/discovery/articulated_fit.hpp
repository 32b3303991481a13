// A rig laid on scans: bones that cannot stretch, joints that hold.
#pragma once

#include "retarget/discovery/thinned_frames.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// What is laid on the scans: points of the rig's surface at rest.
struct FittedSurface {
  Points points, normals;  ///< [N, 3] at rest
  SkinWeights skin;        ///< of these points
};

/// The normals at the surface's points when its bones move so, each turned with its main bone, [N, 3].
Points posed_normals(const FittedSurface& surface, const BoneMotions& bones);

/// A stiffness of joints that nothing gives in.
constexpr float kRigidJoints = 1000;

struct ArticulatedFitOptions {
  float first_radius_m = 0.05f,
        last_radius_m = 0.02f;  ///< scale of what counts as off the scan, first to last round
  float joint_stiffness = 1;    ///< of joints, in what a whole bone's points weigh
  int rounds = 6;
};

/// Lays bones on one scan, from where they are thought to be: Gauss-Newton over six numbers a bone; the
/// surface's points come to lie on the scan and the scan on them (point to plane, Geman-McClure), joints hold
/// what their kind does not let go. What turns freely on a round limb stays as it was.
void fit_bones(const Rig& rig, const FittedSurface& surface, const ThinnedFrame& scan,
               const ArticulatedFitOptions& options, BoneMotions& bones);

/// How far a surface is from a scan.
struct ScanDistances {
  Eigen::VectorXf off;  ///< [N] of each of its points from the scan's nearest, metres
  float spacing_m = 0;  ///< of the scan: from a point to the next, the median
};
ScanDistances distances_to(const ThinnedFrame& scan, const FittedSurface& surface, const BoneMotions& bones);

/// Weights at places between points whose weights are known: of the nearest ones, the more the nearer.
SkinWeights weights_between(const Points& places, const Points& known, const SkinWeights& weights, int bones);

}  // namespace understudy
