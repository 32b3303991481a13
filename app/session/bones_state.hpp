// The skeleton of its own that is looked for, and found, in the source's scans.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/discovery/discover.hpp"

namespace understudy::app {

/// Which of the 22 joints of people a found one stays nearest to, in the mean over frames.
struct NearJoint {
  int joint = -1;      ///< -1: none, no frame shows both
  float apart_m = 0;   ///< metres
  float share = 0;     ///< the same of the diagonal of the body's box
  bool names = false;  ///< near enough to have its name, and nearer than any other found one
};

/// The found joint that is the nearest to one of the 22 in most frames (paper 3, eq. 21).
struct SteadyJoint {
  int bone = -1;
  double share = 0;   ///< of the frames that show both
  float apart_m = 0;  ///< metres, mean over all of these
};

struct BonesState {
  std::shared_ptr<const DiscoveredRig> rig;  ///< with the document's edits; null: none yet
  std::string problem;                       ///< why there is none, one sentence; empty: no problem
  bool waits = false;                        ///< for the source's frames, before it begins
  int64_t job = 0;                           ///< that looks for it; 0: none
  std::string stage;                         ///< of that work, as DiscoveryProgress has it; "Fit" of edits
  float share = 0;                           ///< of it that is done, 0 .. 1
  /// What that work has found so far; null: nothing, or it is over.
  std::shared_ptr<const PartsSoFar> so_far;
  int selected = -1;                ///< joint of the rig
  std::vector<NearJoint> near;      ///< of each joint; empty: the source is no person
  std::vector<SteadyJoint> steady;  ///< of each of the 22; empty as well where no frame shows both
};

/// Which frame of what was found belongs to one of the source; -1: none.
int frame_of_rig(const DiscoveredRig& rig, int source_frame);

}  // namespace understudy::app
