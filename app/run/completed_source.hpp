// A source that is made: sparse scans, completed to a motion of a whole body.
#pragma once

#include <memory>

#include "app/run/source.hpp"
#include "retarget/pipeline/sparse_fitter.hpp"

namespace understudy::app {

/// What was made, to be handed out again without making it anew.
struct MadeCapture {
  CompletedCapture capture;
  int64_t first = 0;     ///< the frame that it begins with
  std::string sentence;  ///< of units, axes and what was made
  Eigen::Matrix4d to_file = Eigen::Matrix4d::Identity();

  /// Of a frame of the source that was made and not captured, as Motion::doubt_m; else 0.
  float doubt_of(int64_t frame) const;
};

/// The markers in a table, which stand on places that are known. Throws Error naming it.
std::vector<MarkerFrame> known_markers(const std::string& path, double fps = 30);

/// Frames at `options.complete` per second of the one person whom `scans` and the markers in
/// `options.markers` show, each with the exact skeleton and the surface of the body that was fitted to all of
/// them (paper 2, section 6; SparseFitter). Looks both ways: the first next() reads all scans and makes the
/// motion, by the tools of set_tools(). `options.edits` are applied to each scan. Scans of fewer than ten
/// points, and markers from before the first scan or after the last, are left out, which is logged. The soles
/// of the body are the floor where none is forced. Throws Error in next(), naming the source: without tools,
/// where fewer than two scans are left, and what the fitter refuses; naming the markers: none is from the
/// time of the scans.
std::unique_ptr<Source> complete_scans(std::unique_ptr<Source> scans, const SourceOptions& options);

}  // namespace understudy::app
