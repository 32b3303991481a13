// Which of a character's animations is meant, and at which times it is looked at.
#pragma once

#include <cstdint>
#include <string>

#include "retarget/character/character.hpp"

namespace understudy {

/// The number of an animation by its name or its number from 1; empty: the longest. Throws Error, which lists
/// them, when there is none like it.
int chosen_clip(const Character& character, const std::string& clip);

/// Frames of an animation at one rate.
struct ClipTimes {
  double start = 0, fps = 30;  ///< seconds of the first frame
  int64_t count = 1;
  float at(int64_t frame) const { return static_cast<float>(start + static_cast<double>(frame) / fps); }
};

/// The frames of animation number `clip`. fps 0: the rate at which the keys lie, 30 where they lie at none.
/// Throws Error naming the character where they are more than a day has at 60 frames/s.
ClipTimes clip_times(const Character& character, int clip, double fps = 0);

}  // namespace understudy
