// Movements as the poses at evenly spread moments: the plain coder, beside which a learned one is judged.
#pragma once

#include <memory>

#include "retarget/pipeline/motion_coder.hpp"

namespace understudy {

/// A code is the movement's evenly spread poses as they are (step_numbers): what lies between two codes is
/// the straight line between their poses. It needs no weights.
std::unique_ptr<MotionCoder> make_knot_coder();

/// Of a movement from the origin, facing +z, evenly many poses: number i of `count` at i / (count - 1) of its
/// time. Throws Error for fewer than two poses, and for times that do not rise.
std::vector<Pose> sampled_evenly(const TimedPoses& movement, int count);

}  // namespace understudy
