// Figures of each frame from joints and poses alone: what can be plotted at once.
#pragma once

#include <memory>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// What the figures are of; all sequences equally long or longer than `shown`.
struct FigureInput {
  const Motion& shown;
  const std::vector<Joints>& joints;  ///< of the target
  const std::vector<KeptSource>& source;
  const Truth* truth = nullptr;  ///< may be null
};

/// confidence and bone_drift of the source; foot_skate and jerk; with truth mpjpe_m, pa_mpjpe_m, acc,
/// rot_deg, head_deg, wrist_deg, foot_deg, extraction_mpjpe_mm, extraction_swap_rate. As many values as
/// frames shown.
std::vector<Series> joint_figures(const FigureInput& input);

/// The order, names and units of every series there is; values empty.
const std::vector<Series>& known_series();
/// Figures of a whole sequence that no frame has by itself; without values.
const std::vector<Series>& known_totals();
/// A series of `known_series` by key, with `count` values NaN.
Series blank_series(const std::string& key, size_t count);

}  // namespace understudy::app
