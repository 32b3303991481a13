// A body performs what another one of its kind did.
#pragma once

#include "retarget/discovery/bone_matching.hpp"

namespace understudy {

struct RigRetargetOptions {
  bool contacts = true;               ///< what stands on the source's ground stands on the target's
  const RigMotion* motion = nullptr;  ///< of the source's rig, performed in place of its own; null: its own
};

/// The target's rig in a pose for each frame of the source's motion: partners turn alike from where they lie
/// alike, bones without one go with their neighbours; the path is the source's, scaled; sliders go as far for
/// their size. Where a bone of the source touches the lowest ground and stays, its partner stays on the
/// target's ground: the path gives first, then the last two bones. Throws Error where matches do not fit.
RiggedMotion performed_by(const RiggedMotion& source, const RiggedMotion& target, const LaidBody& laid,
                          const BoneMatches& matches, const RigRetargetOptions& options = {});

/// A body of which there is one scan: one bone, at rest as it was scanned. A cloud gets a closed surface.
/// Throws Error for a scan without 30 finite points.
RiggedMotion body_of_one_scan(const Mesh& scan);

/// The target's surface in the pose in which the source lies on it, with the source's bones, in their order:
/// joints lie where they went. Its motion is that pose.
RiggedMotion rig_laid_on(const RiggedMotion& source, const RiggedMotion& target, const LaidBody& laid);
/// Every bone is its own partner.
BoneMatches same_bones(int count);

}  // namespace understudy
