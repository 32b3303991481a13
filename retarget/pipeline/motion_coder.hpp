// A space of whole movements, as the rest of the program sees it: a movement is coded as a few numbers, and
// numbers are decoded as a movement.
#pragma once

#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Poses, each with the time when it is taken.
struct TimedPoses {
  std::vector<Pose> poses;
  std::vector<float> seconds;  ///< of each pose; rising, the first is 0

  /// How long the movement takes, s; 0 without poses.
  float duration() const { return seconds.empty() ? 0 : seconds.back(); }
};

/// Of any moment: rotations slerped, the root on a straight line between the two poses around it. Before the
/// first pose and after the last it is that. Throws Error without poses.
Pose pose_at(const TimedPoses& movement, float seconds);

/// A movement as a point of the space.
struct MotionCode {
  std::vector<float> mean;       ///< as many numbers as MotionCoder::size()
  std::vector<float> deviation;  ///< of each number, how sure the coder is of it; empty: it does not say
};

/// Codes movements, so that like ones have like codes. A code says nothing of where a movement begins and
/// which way it heads. Mirrored movements have other codes. One thread at a time.
class MovementEncoder {
 public:
  virtual ~MovementEncoder() = default;
  virtual int size() const = 0;
  /// Of a movement of the body with these T-pose joints, metres. Throws Error for fewer than two poses, times
  /// that do not rise, or a movement that is longer than it can code.
  virtual MotionCode encode(const TimedPoses& movement, const Joints& rest) = 0;
  virtual std::string name() const = 0;
};

/// Codes movements of at most one cycle of the legs (find_steps) with their times and their path over the
/// floor (paper 2, section 3), and makes movements of codes. No more than ten seconds.
class MotionCoder : public MovementEncoder {
 public:
  /// The movement of a body with these T-pose joints: evenly many poses with their times. Floor at y = 0.
  /// Throws Error where `code` has another size or is not finite.
  virtual TimedPoses decode(const std::vector<float>& code, const Joints& rest) = 0;
};

}  // namespace understudy
