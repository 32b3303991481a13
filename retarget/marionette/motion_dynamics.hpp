// What a network knows of how bodies of a kind move: it sees poses, and tells how they may go on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/marionette/motion_keys.hpp"

namespace understudy {

/// A state that follows one motion of one rig. One thread at a time.
class MotionDynamics {
 public:
  virtual ~MotionDynamics() = default;
  /// "hand"
  virtual std::string kind() const = 0;
  /// Begins anew with this rig. Throws Error where its bones, by name and parent, are not the kind's.
  virtual void begin(const Rig& rig) = 0;
  /// The next pose is this one, `dt` seconds after the last.
  virtual void observe(const RigPose& pose, double dt) = 0;
  /// A pose that may come next; it is the last one from then on. Throws Error before any was observed.
  virtual RigPose sample(double dt, Rng& rng) = 0;
  /// The last pose is so much higher, metres. Throws Error before there was one.
  virtual void raise(float height) = 0;
  /// Frames 0 to the last key's, in each key exactly its pose: a way there that this kind of body may take,
  /// another with another state of `rng`. The first key is of frame 0. It begins anew and leaves the state
  /// after the last.
  virtual std::vector<RigPose> aimed(const std::vector<PoseKey>& keys, double dt, Rng& rng) = 0;
  /// A copy that goes its own way.
  virtual std::unique_ptr<MotionDynamics> clone() const = 0;
};

}  // namespace understudy
