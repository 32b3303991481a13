// How much a detector jitters, seen on the track itself.
#pragma once

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// Third differences of places over time: of a body they are small, of jitter twenty times its variance.
/// Online, of constant memory.
class TrackJitter {
 public:
  /// The next pose follows no other: a cut. What is known of the detector stays.
  void restart() { known_ = 0; }
  /// dt: seconds since the pose before; frames far apart say nothing.
  void push(const FlatPose& seen, float dt);
  /// Standard deviation of each coordinate, pixels; below 0 as long as nobody knows.
  float pixels() const { return pixels_; }

 private:
  std::array<FlatPose, 3> before_;  // the newest first
  int known_ = 0;
  float last_dt_ = 0, pixels_ = -1, seconds_ = 0;
};

}  // namespace understudy
