// What a file of 2D poses tells of itself, without a truth.
#pragma once

#include <string>
#include <vector>

#include "app/run/evaluator.hpp"
#include "app/run/flat_performance.hpp"

namespace understudy::app {

struct FlatFigures {
  std::vector<std::string> told;  ///< how it was read
  int64_t frames = 0;
  int64_t flagged = 0;  ///< nothing in them could be used
  int64_t mended = 0;   ///< left and right were exchanged
  /// seen: per cent of the 25 points, in frames that can be used; jitter_px: of the file, TrackJitter, and
  /// jitter_after: mean second difference cleaned over as it is; violation: per cent of the pairs of points
  /// whose order cleaning changes; drift: per cent by which the lengths change that are read off each pose
  Metrics metrics;
};

/// Of who performs in it. Throws Error naming the file.
FlatFigures flat_figures(const FlatSourceOptions& options, const LengthReader& lengths);

}  // namespace understudy::app
