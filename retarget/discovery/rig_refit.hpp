// Edits of a found rig, its figures along with it, and its poses fitted to the scans again.
#pragma once

#include <functional>

#include "retarget/discovery/discover.hpp"
#include "retarget/rig/rig_edits.hpp"

namespace understudy {

/// Called after each frame or two with the share that is done, 0 .. 1; false ends the work.
using RefitProgress = std::function<bool(float share)>;

/// Fits the poses of all frames to the scans, each from the one it has and from where its neighbour's leads,
/// and measures them anew: off_m, doubted and bones. A frame without points keeps its pose. The scans are
/// those of before any trim. Returns false where progress ended it: nothing has changed then. The same scans
/// give the same bytes. Throws Error for a rig without a surface of 30 points, or other frames than the
/// scans'.
bool refit(DiscoveredRig& rig, const ScanSequence& scans, const RefitProgress& progress = {});

/// An edit of what was found. What is known of bones goes with them (a new bone has its other half's), what
/// is known of frames too; key_frames and rest_frame stay numbers of scans. FitAgain is refit(). Returns the
/// new number of each joint that was there, [J]; nothing where progress ended it. Throws Error as apply() of
/// rig_edits.hpp and refit().
std::vector<int> apply(DiscoveredRig& rig, const RigEdit& edit, const ScanSequence& scans,
                       const RefitProgress& progress = {});

}  // namespace understudy
