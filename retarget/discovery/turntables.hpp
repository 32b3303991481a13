// What turns on a round foot: a turn that the foot's surface does not show.
#pragma once

#include "retarget/discovery/part_tree.hpp"

namespace understudy {

/// A part that stands still and is round about the axis of the hinge on it may end anywhere along that axis:
/// the joint goes to the middle of it, and what is beyond turns. Where a ball joint on such a part turns
/// about two axes alone, one of them the part's own, a bone is put between: it turns on the foot, and the
/// next one on it, and `parts` has one more; not where it has `most` already (0: any number).
void add_turntables(const SurfaceTracks& tracks, RigidParts& parts, PartTree& tree, int most = 0);

}  // namespace understudy
