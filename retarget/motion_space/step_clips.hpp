// The steps of the clips of a data folder: what coders of movements are fitted to and judged by.
#pragma once

#include <string>
#include <vector>

#include "retarget/body/clips.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/motion_space/steps.hpp"

namespace understudy {

struct StepClip {
  Clip clip;                     ///< its path is for the legs of the folder's mean body
  Joints rest = Joints::Zero();  ///< T-pose joints of who performed it, the pelvis at the origin; metres
  bool walks = false;            ///< it shows a walk or a run
  std::vector<Step> steps;       ///< at least one
};

/// The clips of a split in which somebody steps. `mean`: the joints that stand for a performer whose file
/// does not tell them. Throws Error naming a file that cannot be read, and where nobody steps.
std::vector<StepClip> read_step_clips(const DataSplit& split, const Joints& mean);

/// The body that stands for all of a data folder, its pelvis at the origin. Throws Error naming the file.
ShapedBody mean_body(const DataSplit& split);

/// A step as the performer with that body would have gone it: its path as long against the legs.
TimedPoses performed_step(const StepClip& clip, const Step& step, float mean_leg_m);

/// The numbers of every step and of its mirror image as they were captured (step_form.hpp), a row each, the
/// image behind what it shows.
RowMatrix step_rows(const std::vector<StepClip>& clips, float mean_leg_m);

}  // namespace understudy
