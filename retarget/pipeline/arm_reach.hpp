// How far the target's hands reach: as its arms turn, or to where the source's hands are.
#pragma once

#include "retarget/pipeline/running_median.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Moves the wrists by inverse kinematics of the arms; the hands keep their world rotations. With w a wrist
/// and c the middle between the shoulders, of the source A and of the target B as its arms turn:
///   w' = w_B + reach (c_B + (arm_B / arm_A) (w_A - c_A) - w_B)
/// arm: upper arm plus forearm; of A the median over the frames so far. At 0 arms turn as the source's. At 1
/// hands that meet before the source's chest meet before the target's, however broad its shoulders are, as
/// with the goals of an IK retargeter. Looks only back, memory is constant.
class ArmReach {
 public:
  /// reach: 0..1.
  explicit ArmReach(float reach = 0) : reach_(reach) {}
  /// The source starts anew.
  void reset() { arm_a_.clear(); }
  /// The pose with its arms so. rest: the target's T-pose joints; source: the source's joints in this frame,
  /// world, metres.
  Pose push(const Pose& pose, const Joints& rest, const Joints& source);

 private:
  float reach_;
  RunningMedian arm_a_;
};

}  // namespace understudy
