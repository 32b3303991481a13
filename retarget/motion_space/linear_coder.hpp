// A coder of movements that is linear: principal components (what paper 2, section 4.3, compares with).
#pragma once

#include <memory>

#include "retarget/motion_space/step_form.hpp"

namespace understudy {

/// Codes are divided by each component's standard deviation. `rows` [steps, kStepNumbers]: what it is fitted
/// to, more than `size` of them. Throws Error where there are fewer.
std::unique_ptr<MotionCoder> fit_linear_coder(const RowMatrix& rows, int size);

}  // namespace understudy
