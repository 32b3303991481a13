// How well frames of a rig's motion are made that were not known, on cases of the suite marionette-gaps.
#pragma once

#include "app/cli/evaluation.hpp"
#include "app/run/case_folder.hpp"

namespace understudy::app {

/// Keys 3, 5, 10, 15, 20, 25 and 30 frames apart are given, the frames between them made, and the whole
/// surface is compared by eq. 22 of paper 3: m_cd_ENGINE_30 (30 frames apart), m_cd_ENGINE their mean.
/// Engines: lerp, slerp; match, which knows all of the clip but the frames of the one gap; and where the
/// folder of weights has them vrnn and positions (marionette_dynamics_KIND_positions.weights), which know
/// all keys. Generation, as `generate` does it: five frames given, 25 made by vrnn: made_skate, of people,
/// and the clip's own made_skate_true (foot_skate); made_nearest_mm, distance_to_nearest() of the clip, and
/// of people made_nearest_training_mm, of all clips in the training split of options.data where it is told;
/// made_ms. Throws Error.
void evaluate_generation(const Case& c, const EvalOptions& options, CaseResult& result);

}  // namespace understudy::app
