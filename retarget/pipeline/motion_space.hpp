// The motion space as the rest of the program sees it: what completes a motion that is known in part.
#pragma once

#include <string>
#include <vector>

#include "retarget/pipeline/motion_coder.hpp"
#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {

/// A motion, part of which was seen and part of which is to be made.
struct KnownMotion {
  Motion motion;                  ///< at any rate; what is not known is not looked at
  std::vector<KnownParts> known;  ///< of each frame of it
  Joints rest = Joints::Zero();   ///< T-pose joints of who moves, metres
  /// Which of the answers: 0 the best, from 1 on another that is plausible, too (MotionSpace::variations).
  int variation = 0;
};

constexpr int kMostVariations = 4;  ///< that a motion space tells apart

/// What was made of it.
struct Completion {
  Motion motion;  ///< as many frames, at the same rate; what was known is as it was, to the bit
  /// Of each frame the error that its joints are expected to have on average, metres; 0 where all was known.
  std::vector<float> doubt_m;
};

/// Fills what is unknown of a motion (paper 2, section 6). Looks both ways. One thread at a time.
/// Turned or mirrored, the same question has the turned or mirrored answer.
class MotionSpace {
 public:
  virtual ~MotionSpace() = default;
  /// Throws Error where `known` is not as long as the motion, or knows no frame at all.
  virtual Completion complete(const KnownMotion& question) = 0;
  virtual std::string name() const = 0;
  /// How many answers a question has; a KnownMotion::variation beyond them is answered like 0.
  virtual int variations() const { return 1; }
  /// What tells movements of any kind apart; null where it has no codes. On the same thread as complete().
  virtual MovementEncoder* encoder() { return nullptr; }
};

}  // namespace understudy
