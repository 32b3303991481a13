// How well a rig fits scans, in figures of bones and of frames.
#pragma once

#include <vector>

#include "retarget/discovery/articulated_fit.hpp"
#include "retarget/discovery/discover.hpp"

namespace understudy {

/// How far each bone's surface is from the scans, and in how many it is seen, gathered frame by frame. A bone
/// is seen in a frame where at least a fifth of the points that it moves most have one of the scan within
/// three times the scan's spacing.
class BoneDistances {
 public:
  explicit BoneDistances(int bones)
      : off_(static_cast<size_t>(bones), 0),
        weight_(static_cast<size_t>(bones), 1e-9),
        seen_(static_cast<size_t>(bones), 0) {}
  /// Of one frame, of a surface with these weights.
  void add(const SkinWeights& skin, const ScanDistances& distances);
  /// Sets off_m and seen_share, [J]; the latter is not known without a frame.
  void tell(std::vector<FoundBone>& bones) const;

 private:
  std::vector<double> off_, weight_;
  std::vector<int> seen_;
  int frames_ = 0;
};

/// How far bones turn and slide in a motion, [J]; the other figures stay as they were.
void measure_motion(const RiggedMotion& performed, std::vector<FoundBone>& bones);

/// [T] frames that fit clearly worse than the others, or are not known (below 0). Where most fit badly, those
/// that are off by much of the body's size (the diagonal of its box) are compared with the best quarter.
std::vector<bool> doubted_frames(const std::vector<float>& off_m, float size_m);

}  // namespace understudy
