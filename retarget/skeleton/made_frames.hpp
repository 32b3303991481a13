// Which frames of a motion were made, and not captured: told wherever a motion goes.
#pragma once

#include <algorithm>
#include <vector>

#include "retarget/base/index.hpp"

namespace understudy {

struct MadeFrames {
  int first = 0, last = 0;  ///< both inside
  float doubt_m = 0;        ///< the largest in them, as Motion::doubt_m
};

/// From the doubt of each frame, 0 where it was captured.
inline std::vector<MadeFrames> made_frames(const std::vector<float>& doubt_m) {
  std::vector<MadeFrames> made;
  for (int t = 0; t < ssize(doubt_m); ++t) {
    if (doubt_m[t] <= 0) continue;
    if (made.empty() || made.back().last + 1 < t) made.push_back({t, t, 0});
    made.back().last = t;
    made.back().doubt_m = std::max(made.back().doubt_m, doubt_m[t]);
  }
  return made;
}

}  // namespace understudy
