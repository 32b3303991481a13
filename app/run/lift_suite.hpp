// Cases of 2D poses that are to be performed in space.
#pragma once

#include <functional>
#include <string>

#include "app/run/case_maker.hpp"

namespace understudy::app {

/// "lifting".
bool is_lift_suite(const std::string& suite);

/// 30 pairs of people of the split, the second of whom is the target in T-pose, each twice: clean, and with
/// points 15 mm off along each axis (tags). The first does a clip before a camera of any yaw, up to 20 degrees
/// of pitch, 3 to 10 m away, one in four orthographic; its field of view is told, as --fov would. Truth is in the axes of that camera (right, up, back):
/// a lifter that knows nothing of the pitch is judged by what the picture shows. Returns the number of cases.
/// Throws Error naming what is missing.
int make_lift_suite(const SuiteOptions& options, const std::function<void(const std::string&)>& done);

}  // namespace understudy::app
