// A coder of movements that is linear: principal components (what paper 2, section 4.3, compares with).
#pragma once

#include <memory>

#include "retarget/body/body.hpp"
#include "retarget/motion_space/step_form.hpp"

namespace understudy {

/// How far the vertices of a body go, root mean square in metres, for each number of a knot that changes by
/// 1, to first order: [kStepNumbers], of the movement's middle knot and the same for all. Of times it is 1.
/// `body`: its pelvis at the origin.
StepNumbers surface_reach(const ShapedBody& body, const StepNumbers& movement);

/// The directions in which steps differ most, each number counting as much as `scale` [kStepNumbers] says,
/// and their codes: divided by the deviation along each. Throws Error where there are not more rows than
/// `size`.
struct LinearSpace {
  LinearSpace(const RowMatrix& rows, const StepNumbers& scale, int size);

  StepNumbers mean;
  RowMatrix to_codes;      ///< [size, kStepNumbers], of what is off the mean
  RowMatrix to_movements;  ///< [kStepNumbers, size], and back
};

/// That as a coder. `rows` [steps, kStepNumbers] is what it is fitted to; where a body is given, numbers
/// count by its surface_reach, else alike.
std::unique_ptr<MotionCoder> fit_linear_coder(const RowMatrix& rows, int size,
                                              const ShapedBody* body = nullptr);

}  // namespace understudy
