// Evaluates what is made of the frames that a case does not know.
#pragma once

#include <functional>

#include "app/run/evaluator.hpp"
#include "retarget/pipeline/motion_space.hpp"

namespace understudy::app {

/// The vertices of a case's target in a pose, in its file's order; empty: surfaces are not evaluated.
using PosedTarget = std::function<Points(const Pose&)>;

/// A case with gaps, and what fills them.
struct GapCase {
  const Case& c;
  const Truth& truth;
  MotionSpace& space;
  PosedTarget target;
};

/// True rotations and root are known beside the gaps; each window is filled by itself. Gives the milliseconds
/// of each. Throws Error where the truth lacks them.
std::vector<double> evaluate_true_gaps(const GapCase& of, Evaluator& evaluator);

/// A motion as it was performed, filled as a whole.
void evaluate_performed_gaps(const GapCase& of, const KnownMotion& performed, Evaluator& evaluator);

}  // namespace understudy::app
