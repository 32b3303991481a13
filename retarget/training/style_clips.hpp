// Clips in one manner of moving, as words and judges are learned from them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::training {

struct StyleClip {
  std::string path;
  /// Local rotations of frames without a flag, as long as there is none between them, at kWordRate; y is up.
  std::vector<std::vector<Rotations>> runs;
};

/// Visits all clips (.npz, AMASS-format) with a run in the folder and the folders in it, links followed, in
/// the order of their names; how many. Smoothed by a Gaussian of `smooth_frames`: what a capture's noise
/// alone would tell is taken from all manners alike. Throws Error naming the folder where there is none.
int each_style_clip(const std::string& folder, double smooth_frames,
                    const std::function<void(const StyleClip&)>& visit);

}  // namespace understudy::training
