// How large somebody is in the picture, and how far off a detector sees their points.
#pragma once

#include "retarget/keypoints/track_jitter.hpp"

namespace understudy {

/// Online, of constant memory.
class TrackNoise {
 public:
  void reset() { *this = TrackNoise(); }
  /// The next pose follows no other: a cut.
  void restart() { jitter_.restart(); }
  /// dt: seconds since the pose before.
  void push(const FlatPose& seen, float dt);
  float size() const { return size_; }  ///< of the whole person, pixels; 0 before the first pose
  /// Standard deviation of each coordinate of a point that is seen for certain, pixels.
  float sigma() const;

 private:
  TrackJitter jitter_;
  float size_ = 0;
};

}  // namespace understudy
