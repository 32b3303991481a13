// New motions out of one's own, without training: patches of frames are matched and blended, coarse to fine
// (after GenMM: Li, Chen, Li, Sorkine-Hornung, Chen: Example-based Motion Synthesis via Generative Motion
// Matching, SIGGRAPH 2023).
#pragma once

#include <cstdint>
#include <vector>

#include "retarget/marionette/motion_keys.hpp"

namespace understudy {

struct MatchOptions {
  int frames = 90;            ///< of the new motion, at the examples' rate
  std::vector<PoseKey> keys;  ///< met exactly; by rising frames
  bool loop = false;          ///< ends in the pose that it begins with, wherever it has gone
  uint64_t seed = 1;          ///< the same gives the same motion
};

/// A motion of the rig that is made of these examples (pieces of one clip, or several, at one rate): every
/// patch of it looks like one of theirs, and as much of theirs as there is room for comes again. Joints keep
/// their kinds. Where the rig has a surface, what stands on the ground in the examples stands in it. Without
/// keys it begins where the first example does. Throws Error for frames < 2, no example of two frames, or
/// keys that do not fit.
RigMotion matched_motion(const Rig& rig, const std::vector<RigMotion>& examples, const MatchOptions& options);

/// How far a motion is from any piece of an example that is as long, or from the example where that is
/// shorter: mean distance of joints, metres, each frame's root on the other's, facing one way. 0: a copy.
double distance_to_nearest(const Rig& rig, const std::vector<RigPose>& motion,
                           const std::vector<RigPose>& example);

}  // namespace understudy
