// How well a rig fits scans, in figures of bones and of frames.
#pragma once

#include <vector>

#include "retarget/discovery/articulated_fit.hpp"
#include "retarget/discovery/discover.hpp"

namespace understudy {

/// How far each bone's surface is from the scans, gathered frame by frame.
class BoneDistances {
 public:
  explicit BoneDistances(int bones)
      : off_(static_cast<size_t>(bones), 0), weight_(static_cast<size_t>(bones), 1e-9) {}
  /// Of one frame: of each point of a surface with these weights, metres.
  void add(const SkinWeights& skin, const Eigen::VectorXf& distances);
  float mean(size_t bone) const { return static_cast<float>(off_[bone] / weight_[bone]); }

 private:
  std::vector<double> off_, weight_;
};

/// How far bones turn and slide in a motion, [J]; off_m stays as it was.
void measure_motion(const RiggedMotion& performed, std::vector<FoundBone>& bones);

/// [T] frames that fit clearly worse than the others, or are not known (below 0).
std::vector<bool> doubted_frames(const std::vector<float>& off_m);

}  // namespace understudy
