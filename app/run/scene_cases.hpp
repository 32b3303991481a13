// Scenes: one to four people who cross, shake hands, leave and come back among ground, walls and furniture.
#pragma once

#include "app/run/actor.hpp"
#include "app/run/case_maker.hpp"

namespace understudy::app {

/// As make_suite, of the suite "scenes". Beside what all cases have: "alone" in case.json, and the truth's
/// arrays of people (case_folder.hpp).
int make_scene_cases(const SuiteOptions& options, const Cast& cast,
                     const std::function<void(const std::string&)>& done);

}  // namespace understudy::app
