// Makes the suite `inbetween` of test cases: motions with gaps, with scans of what is known or without any.
#pragma once

#include "app/run/case_maker.hpp"
#include "retarget/body/data_folder.hpp"

namespace understudy::app {

/// A case for each clip of the split in which a window fits, named after the clip, performed by the
/// template's body. Truths hold rotations, joints and target_joints; where there are points, vertices too,
/// and the target is that body. See SuiteOptions::gap and `walks`, and gap_plan.hpp. Throws Error where no
/// clip is left.
int make_inbetween_suite(const SuiteOptions& options, const DataSplit& split,
                         const std::function<void(const std::string& name)>& done);

/// Tags of a clip: the suite's name, what it shows, and "travels" where the pelvis goes at more than 0.6 m/s
/// across the floor half of the time, or the clip is a walk or run.
std::vector<std::string> inbetween_tags(const Motion& motion, const std::vector<std::string>& labels);

}  // namespace understudy::app
