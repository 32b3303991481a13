// Where a known rig is in a scan that nothing came before.
#pragma once

#include "retarget/rig/rig.hpp"

namespace understudy {

/// The pose, among those that the rig is known in, turned about y and moved, in which its surface is most
/// like the scan, then laid on it. Throws Error for a scan without 30 finite points and a rig without a
/// surface.
RigPose first_pose(const RiggedMotion& known, const Mesh& scan);

}  // namespace understudy
