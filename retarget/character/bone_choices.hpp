// The user's corrections of a bone map as a file.
#pragma once

#include <string>
#include <string_view>

#include "retarget/character/bone_map.hpp"

namespace understudy {

/// A JSON object of joints' and bones' names: {"left_wrist": "Hand.L"}. Throws Error naming `path`.
BoneChoices parse_bone_choices(std::string_view text, const std::string& path);
BoneChoices read_bone_choices(const std::string& path);

}  // namespace understudy
