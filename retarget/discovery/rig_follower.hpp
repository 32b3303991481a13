// Poses of a rig in scans that come one after the other.
#pragma once

#include "retarget/discovery/articulated_fit.hpp"

namespace understudy {

/// Lays a rig on each new scan, near where the frames before lead. Looks only back, memory is constant. The
/// same scans give the same poses. One thread at a time, but for fit().
class RigFollower {
 public:
  /// Throws Error for a rig without a surface of 30 points.
  explicit RigFollower(const Rig& rig);
  /// Where the rig is before the next scan; without it the first scan is thought to show it at rest.
  void start_from(const RigPose& pose);

  struct Followed {
    RigPose pose;
    ScanDistances distances;  ///< of surface() in that pose
    float off_m() const { return distances.off.mean(); }
  };
  /// Throws Error for a scan without 30 finite points.
  Followed follow(const Mesh& scan);

  /// A scan as it is looked at. Throws Error for one without 30 finite points.
  static ThinnedFrame seen(const Mesh& scan);
  /// One scan alone, from where the bones are thought to be. Several threads may.
  Followed fit(const ThinnedFrame& scan, BoneMotions bones) const;
  const FittedSurface& surface() const { return surface_; }

 private:
  Rig rig_;
  FittedSurface surface_;
  float spacing_m_;
  BoneMotions last_, before_;
};

}  // namespace understudy
