// Judges of the manner that a motion is performed in.
#pragma once

#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What each of three judges says of a clip: one of styles(), twice, and one of contents().
struct Verdict {
  std::string look;          ///< the style by posture, amplitude and speed
  std::string coordination;  ///< the style by how joints hang together in time alone
  std::string content;       ///< what is done; empty where the judge was taught with clips that do not say
};

class StyleJudge {
 public:
  virtual ~StyleJudge() = default;
  /// Of a whole clip: local rotations of each frame, y up, in any direction; fps > 0. Throws Error where it
  /// has no frame, or its rotations are not finite. One thread at a time.
  virtual Verdict judge(const std::vector<Rotations>& local, double fps) = 0;
  virtual const std::vector<std::string>& styles() const = 0;
  virtual const std::vector<std::string>& contents() const = 0;
};

}  // namespace understudy
