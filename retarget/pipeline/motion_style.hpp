// A stage from skeleton to skeleton, between observation and performance.
#pragma once

#include "retarget/pipeline/observation.hpp"

namespace understudy {

/// Changes how the source moves before anything of the target is asked. Looks only back, one thread at a
/// time.
class MotionStyle : public Remembering {
 public:
  /// The source starts anew.
  virtual void reset() = 0;
  /// The frame to be performed in the place of this one, dt seconds after the one before. Only believed
  /// frames come. Throws Error where it cannot be; the frame is then refused.
  virtual Observation push(Observation seen, float dt) = 0;
};

}  // namespace understudy
