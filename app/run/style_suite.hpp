// Cases of performance style: clips that are to be taken from one manner of moving to another, and real ones
// of that other manner to be judged beside them.
#pragma once

#include <functional>
#include <string>

#include "app/run/case_maker.hpp"

namespace understudy::app {

/// Of each clip (.npz, AMASS-format) in SuiteOptions::data/from and data/to, and in folders in them, a case
/// that holds a copy of it: case.json says whose it is and in which manner (StyleCase). With `cases` at most
/// so many of each. Throws Error naming a folder that has none.
int make_style_suite(const SuiteOptions& options, const std::function<void(const std::string& name)>& done);

}  // namespace understudy::app
