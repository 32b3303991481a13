// Makes the suites `inbetween` and `predict` of test cases: motions with gaps, or whose end is not known,
// with scans of what is known or without any.
#pragma once

#include "app/run/case_maker.hpp"
#include "retarget/body/data_folder.hpp"

namespace understudy::app {

/// A case for each clip of the split in which a window fits, named after the clip, performed by the
/// template's body. Truths are gap_truth's; where there are points the target is that body. See
/// SuiteOptions::gap and `walks`, and gap_plan.hpp. Throws Error where no clip is left.
int make_inbetween_suite(const SuiteOptions& options, const DataSplit& split,
                         const std::function<void(const std::string& name)>& done);

}  // namespace understudy::app
