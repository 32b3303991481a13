// AMASS-format motions without a body of their own.
#pragma once

#include <string>

#include "retarget/character/character.hpp"

namespace understudy {

/// The 22 joints of a mean adult in T-pose as nodes, named as in kJointNames, and the motion of an
/// AMASS-format .npz as their one animation; no part. Axes are the file's. Throws Error naming the file.
Character read_amass_character(const std::string& path);

}  // namespace understudy
