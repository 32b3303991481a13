// Makes the suite `sparse` of test cases: steps of which a few frames are known, by few points or markers.
#pragma once

#include "app/run/case_maker.hpp"
#include "retarget/body/data_folder.hpp"

namespace understudy::app {

/// A case for each step (find_steps) of the split's clips, named after the clip and the step's first frame.
/// Whatever its duration, a step has 100 frames, evenly between its first and its last (paper 2, section 3.1:
/// rotations slerped, the path straight between the clip's frames), of which SuiteOptions::known are known,
/// evenly. With neither points nor markers it is performed by the template's body and has a truth alone.
/// Else by people of the split, one after the other; the source is points drawn anew in each known frame and
/// its times.csv, markers.csv has where the markers are (marker_places.hpp), the target is who performs. Of
/// more cases than SuiteOptions::cases some are taken, evenly. Throws Error where nobody steps.
int make_sparse_suite(const SuiteOptions& options, const DataSplit& split,
                      const std::function<void(const std::string& name)>& done);

}  // namespace understudy::app
