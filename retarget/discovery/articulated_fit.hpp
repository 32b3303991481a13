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

struct ArticulatedFitOptions {
  float first_radius_m = 0.05f,
        last_radius_m = 0.02f;  ///< scale of what counts as off the scan, first to last round
  float joint_stiffness = 1;    ///< of joints, in what a whole bone's points weigh; 1000: nothing gives
  int rounds = 6;
};

/// Lays bones on one scan, from where they are thought to be: Gauss-Newton over six numbers a bone; the
/// surface's points come to lie on the scan and the scan on them (point to plane, Geman-McClure), joints hold
/// what their kind does not let go. What turns freely on a round limb stays as it was.
/// Returns how far the surface then is from the scan, mean over its points, metres.
float fit_bones(const Rig& rig, const FittedSurface& surface, const ThinnedFrame& scan,
                const ArticulatedFitOptions& options, BoneMotions& bones);

}  // namespace understudy
