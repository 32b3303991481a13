// People's 22 joints as a rig like any other.
#pragma once

#include "retarget/rig/rig.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The 22 joints where they are in the T-pose, metres, called "person"; no surface.
Rig person_rig(const Joints& rest);
/// The same pose for it.
RigPose person_pose(const Pose& pose);

}  // namespace understudy
