// How well 2D poses are performed in space, on cases of the suite lifting.
#pragma once

#include "app/cli/evaluation.hpp"
#include "app/run/case_folder.hpp"

namespace understudy::app {

/// Of the lifted joints as they come: n_mpjpe_mm (the middle of the hips on that of the truth, each frame in
/// its best scale), pa_mpjpe_mm (scaled_joints, aligned_joints), the same of the twelve joints of arms and
/// legs, neck and head (n_mpjpe_points_mm), n_mpjpe_smooth_mm of what the pipeline's filter makes of them;
/// swaps and flips, per cent (swap_rate, flip_rate); expected_mm, how far joints are expected to be off, and
/// confidence_corr, its correlation with how far they are. Of the target: target_pa_mpjpe_m, target_swaps,
/// target_flips. Throws Error.
void evaluate_lifted(const Case& c, const EvalOptions& options, CaseResult& result);

}  // namespace understudy::app
