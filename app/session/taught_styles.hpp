// Where taught styles are kept: a file each in a folder beside the settings.
#pragma once

#include <string>
#include <vector>

#include "app/session/styles_state.hpp"

namespace understudy::app {

/// "styles" beside the settings; empty where none are kept.
std::string styles_folder(const std::string& settings_file);
/// What is in that folder. What cannot be read is left out and logged.
std::vector<TaughtStyle> taught_styles(const std::string& folder);
/// Why no style can be called so, one sentence; empty: it can.
std::string why_no_style_name(const std::string& name);

}  // namespace understudy::app
