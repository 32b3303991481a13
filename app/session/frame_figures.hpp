// Figures of each frame that need joints and poses alone, so they can be plotted at once.
#pragma once

#include <memory>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// The inputs of the figures; `joints` is as long as `shown`, `performed` as its part that was performed.
struct FigureInput {
  const Motion& shown;
  const std::vector<Joints>& joints;           ///< of the target
  const SharedFrames<KeptFrame>& performed;    ///< with the source's joints as the take transferred them
  const SharedFrames<KeptSource>& source;      ///< may be shorter: then nothing is measured against it
  const Truth* truth = nullptr;                ///< may be null
  bool has_style = false;                      ///< figures of how it is performed are wanted, too
  const std::vector<double>* times = nullptr;  ///< as TakeState's: what moves is as fast as it is seen
};

/// Every metric of the table of single frames that joints and poses give, as far as its input is known. As
/// many values as frames shown, NaN beyond those that were performed.
std::vector<Series> joint_figures(const FigureInput& input);

/// The series of a metric by key, with `count` values NaN. Throws Error when there is none.
Series blank_series(const std::string& key, size_t count);

}  // namespace understudy::app
