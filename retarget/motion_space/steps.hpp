// Steps: stretches of a motion that are one cycle of the legs (paper 2, section 4.1).
#pragma once

#include <vector>

#include "retarget/pipeline/motion_coder.hpp"

namespace understudy {

/// Frames first .. last of a motion, both inside: from one foot's stride to the same foot's next.
struct Step {
  int first = 0, last = 0;
  bool left_first = false;  ///< the left foot strides first
  float distance = 0;       ///< radians a frame from the reference cycle, by dynamic time warping of the hips
};

/// All steps of a motion of 0.3 to 3 s, in the order of their first frames; both feet's starts count, so they
/// overlap. Candidates lie between two like zero crossings of left less right hip flexion; kept are those
/// whose hip rotations are near the built-in walk's or its mirror image's by dynamic time warping. None where
/// nobody steps. Frames with a flag (Motion::flags) are in no step.
std::vector<Step> find_steps(const Motion& motion);

/// The frames of a step, seen from the first: above the origin, facing +z, heights from the floor as they
/// are.
TimedPoses movement_of(const Motion& motion, int first, int last);

}  // namespace understudy
