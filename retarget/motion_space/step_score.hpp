// How far steps that are coded and decoded are from what they were (paper 2, section 4.3, figures 3 to 5).
#pragma once

#include "retarget/motion_space/step_clips.hpp"

namespace understudy {

struct StepErrors {
  int steps = 0;
  double joints_mm = 0;    ///< mean distance of joints in the world
  double vertices_mm = 0;  ///< the same of vertices
  double duration_ms = 0;  ///< mean difference of durations
};

struct StepScore {
  StepErrors all, walks;  ///< of all steps, and of those in clips of walks and runs
};

struct StepScoreOptions {
  int frames = 100;       ///< evenly spread over each step
  int every_vertex = 30;  ///< of the body
};

/// Codes and decodes each step with the body that its performer has, and performs both on the mean body;
/// frames are compared one by one, the first with the first (paper 2), whatever their times are. `body`: the
/// mean one.
StepScore score_steps(MotionCoder& coder, const std::vector<StepClip>& clips, const ShapedBody& body,
                      const StepScoreOptions& options = {});

}  // namespace understudy
