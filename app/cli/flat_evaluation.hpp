// How well 2D poses are performed on cases of the suites pose2d, pose2d-odd, pose2d-noisy and pose2d-seen.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/cli/evaluation.hpp"
#include "app/cli/flat_pictures.hpp"
#include "app/run/case_folder.hpp"
#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy::app {

/// Of the engine, hands let go: oks (keypoint_similarity), nmpjpe2d, violation, angles_rad, jitter (mean
/// second difference over the truth's); of points that the source shows. With hands that keep touching:
/// oks_touches, violation_touches, near_kept; near_truth is what the truth keeps. bone_ratio of the target's
/// lengths. Beside it oks of what others do: oks_copy, oks_scale (one scale over the track, least squares of
/// lengths), oks_one (each bone's ratio in the first frames), oks_longest (in the longest of the tracks),
/// oks_true (the true ratios: the limit).
class FlatEvaluation {
 public:
  /// Throws Error where a network cannot be loaded, and where --engine is for what moves in space.
  explicit FlatEvaluation(const EvalOptions& options);
  void evaluate(const Case& c, CaseResult& result);
  /// Of the first six cases whose target is known from one picture, where pictures are wanted: a moment of
  /// each, by all engines.
  const std::vector<FlatMoment>& moments() const { return moments_; }

 private:
  void keep_moment(const Case& c, const FlatMoment& moment, size_t frame);

  std::string engine_;
  bool pictures_;
  std::vector<FlatMoment> moments_;
  FlatTools tools_;
};

}  // namespace understudy::app
