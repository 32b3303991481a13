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

/// The largest doubt of the frames first..last, both inside, metres; 0 where none of them was made.
inline float largest_doubt(const std::vector<float>& doubt_m, int first, int last) {
  float largest = 0;
  for (int t = std::max(0, first); t <= std::min(last, static_cast<int>(doubt_m.size()) - 1); ++t)
    largest = std::max(largest, doubt_m[t]);
  return largest;
}

}  // namespace understudy
