// Figures of each frame that need joints and poses alone, so they can be plotted at once.
#pragma once

#include <memory>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// The inputs of the figures; every sequence is at least as long as `shown`.
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
/// Figures that only a whole sequence has; without values.
const std::vector<Series>& known_totals();
/// A series of `known_series` by key, with `count` values NaN.
Series blank_series(const std::string& key, size_t count);

}  // namespace understudy::app
