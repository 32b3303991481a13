// Evaluates what is made of the frames that a case does not know.
#pragma once

#include <functional>

#include "app/run/evaluator.hpp"
#include "retarget/pipeline/motion_space.hpp"

namespace understudy::app {

/// A surface in poses that were made, and in the true ones, [V, 3] in one order; empty: surfaces are not
/// evaluated.
struct GapSurface {
  std::function<Points(const Pose&)> made;
  std::function<Points(int64_t frame)> truth;
  bool is_dense = false;    ///< chamfer_m can be told of it
  bool is_another = false;  ///< its vertices are not the truth's, mve_m cannot be told
};

/// A case with gaps.
struct GapCase {
  const Case& c;
  const Truth& truth;
  GapSurface surface;
};

/// True rotations and root are known beside the gaps; each window is filled by itself. The surface is the
/// truth's own skin. Gives the milliseconds of each. Throws Error where the truth lacks them.
std::vector<double> evaluate_true_gaps(const GapCase& of, MotionSpace& space, Evaluator& evaluator);

/// A motion as it was performed, filled as a whole; where nothing is known after a gap, window by window.
void evaluate_performed_gaps(const GapCase& of, MotionSpace& space, const KnownMotion& performed,
                             Evaluator& evaluator);

/// What was made of a case by whatever way: all its frames, of somebody whose T-pose joints are `rest`. Where
/// the case is one window, with a dense surface, chamfer_m is of each of its frames.
void evaluate_completion(const GapCase& of, const Joints& rest, const Completion& made, Evaluator& evaluator);

}  // namespace understudy::app
