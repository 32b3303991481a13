// What 2D poses go through, as the pipeline sees it: abstract, so that no user of it needs LibTorch.
#pragma once

#include <string>

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// How long a person's bones are, as one pose of theirs tells.
struct PoseLengths {
  BoneLengths log_length;  ///< logarithm of pixels
  BoneLengths doubt;       ///< its standard deviation
};

/// Reads lengths off poses, foreshortened or not. What is const may be called from several threads at once.
class LengthReader {
 public:
  virtual ~LengthReader() = default;
  /// Throws Error when fewer than two points of the first 15 are seen, or the answer is not finite.
  virtual PoseLengths read(const FlatPose& pose) const = 0;
};

/// One person's pose in, another's out (paper 5's task). One thread at a time.
class KeypointTransfer {
 public:
  virtual ~KeypointTransfer() = default;
  /// The pose of a person of lengths `to` who does what one of lengths `from` does in `source`. The mid-hip,
  /// without one the neck, stays where it is. What is missing there is missing here, but for engines that
  /// make it up, which give it low confidence.
  virtual FlatPose transfer(const FlatPose& source, const Proportions& from, const Proportions& to) = 0;
  virtual std::string name() const = 0;
};

/// Which engine of 2D poses is wanted.
struct FlatEngine {
  std::string name;     ///< one of flat_engines()
  bool touches = true;  ///< hands that touch keep touching; of engines that can let them go
  double fps = 30;      ///< of the poses; for those to whom time counts
};

}  // namespace understudy
