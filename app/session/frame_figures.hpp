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

/// Every metric of the table that frames have and joints and poses tell, as far as what it needs is known. As
/// many values as frames shown.
std::vector<Series> joint_figures(const FigureInput& input);

/// The series of a metric by key, with `count` values NaN. Throws Error when there is none.
Series blank_series(const std::string& key, size_t count);

}  // namespace understudy::app
