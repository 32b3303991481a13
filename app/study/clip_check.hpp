// Whether a folder of stimuli has the clips of a study as it is now.
#pragma once

#include <string>
#include <vector>

#include "app/study/study.hpp"

namespace understudy::app {

/// `clips`: "clips/NAME.mp4", each; `path`: the study's file; `folder`: that `study stimuli` wrote. Throws
/// Error, one sentence that says how clips are made: one is not there or, as the folder's manifest says, is
/// damaged, or they are of the study before it was changed.
void check_clips(const std::vector<std::string>& clips, const Study& study, const std::string& path,
                 const std::string& folder);

}  // namespace understudy::app
