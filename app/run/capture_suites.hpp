// Suites of simulated captures: people as sensors have them, half people, and scenes of several.
#pragma once

#include "app/run/case_maker.hpp"
#include "retarget/body/data_folder.hpp"

namespace understudy::app {

/// Whether a suite is made here: "partial", "sensors", "scenes" (make_suite).
bool is_capture_suite(const std::string& suite);
/// As make_suite; the split's motions are known.
int make_capture_suite(const SuiteOptions& options, DataSplit split,
                       const std::function<void(const std::string&)>& done);

}  // namespace understudy::app
