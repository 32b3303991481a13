// What an engine of styles does: local rotations of a person in, styled ones out (paper 4's task).
#pragma once

#include <optional>

#include "retarget/math/smooth_step.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// A frame of the source.
struct StyleFrame {
  Joints rest = Joints::Zero();  ///< the source's bones in T-pose, metres, as far as they are known by now
  Pose pose;                     ///< of them
  float dt = 0;                  ///< seconds since the frame before
};

/// How far a pelvis that is turned so stands: 1 upright .. 0 it lies, or hangs head down, and has no heading.
/// What has none is left as it is.
inline float uprightness(const Mat3& pelvis) {
  return smooth_step(0.3f, 0.7f, pelvis(1, 1));
}

/// An engine. Looks at no heading and no place: turning or moving the source turns or moves the result. One
/// thread at a time.
class PoseStyle {
 public:
  virtual ~PoseStyle() = default;
  virtual void reset() = 0;
  virtual void push(const StyleFrame& frame) = 0;
  /// The next frame's local rotations, in the order of push(); none: it needs more, or finish(). Where the
  /// pelvis goes follows from the feet.
  virtual std::optional<Rotations> pop() = 0;
  virtual void finish() {}
  virtual float lag_s() const { return 0; }
};

}  // namespace understudy
