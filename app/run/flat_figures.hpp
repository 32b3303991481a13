// What a file of 2D poses tells of itself, without a truth.
#pragma once

#include <array>
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

/// What is told of a performed take of 2D poses, in this order; the lower the better.
struct FlatFigure {
  const char *key, *label, *unit;
};
constexpr std::array<FlatFigure, 3> kFlatFigures = {{{"violation", "Order changed", "%"},
                                                     {"drift", "Lengths change", "%"},
                                                     {"jitter", "Jitter", "of the source's"}}};
/// Null where it is none of them.
const FlatFigure* find_flat_figure(const std::string& key);

/// Per cent by which the lengths change that are read off each of the poses; nobody's, and those of whom
/// little is seen, do not count. NaN where none does.
double length_drift(const std::vector<FlatPose>& poses, const LengthReader& lengths);
/// Mean second difference of the points' places, pixels a frame squared; NaN where none is known.
double mean_second_difference(const std::vector<FlatPose>& poses);

/// Of who performs in it. Throws Error naming the file.
FlatFigures flat_figures(const FlatSourceOptions& options, const LengthReader& lengths);

}  // namespace understudy::app
