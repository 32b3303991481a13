// Standing feet do not slide, online.
#pragma once

#include "retarget/pipeline/root_path.hpp"
#include "retarget/skeleton/foot_contact.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

struct FootLockOptions {
  FootContactOptions contact = {0.02f, 0.04f, 0.6f, 1.0f};  ///< of the source's feet
  float release_s = 0.08f;  ///< time constant in which a correction fades once the foot has left
  float creep_s = 1.0f;     ///< the same while it stands: what was wrong at the landing is made good slowly
  float max_offset_m = 0.12f;  ///< a foot held further from where it should be slips (leg 0.8 m)
};

/// Holds each standing foot of the target by inverse kinematics of its leg. Looks only back, memory is
/// constant. The ball of the foot is held, and the heel while it alone stands: a foot may roll, not slide.
class FootLock {
 public:
  explicit FootLock(const FootLockOptions& options = {}) : options_(options) {}
  void reset() { started_ = false; }
  /// The pose with its standing feet held. rest: the target's T-pose joints; source: the source's joints in
  /// this frame, world, which decide what stands; dt seconds since the frame before; seen: of the source's
  /// feet, those that are not seen are not held.
  Pose push(const Pose& pose, const Joints& rest, float dt, const Joints& source,
            Standing seen = {true, true});
  /// Which feet stand in the last frame: left, right.
  Standing standing() const { return standing_; }

 private:
  void start(const Joints& source);
  std::array<bool, 4> contacts(const Joints& source, float dt);

  FootLockOptions options_;
  std::array<ContactSwitch, 4> switches_;  // of the source's left ankle, right ankle, left ball, right ball
  std::array<float, 4> levels_{};          // heights at which each of them stands
  std::array<Vec3, 2> offset_, last_heel_, last_ball_;  // a side: correction; pivots of the pose as it came
  Standing standing_{};
  std::array<bool, 2> stood_on_ball_{};
  bool started_ = false;
};

}  // namespace understudy
