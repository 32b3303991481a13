// The styles that come with the program, and the style of a name or a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/style/manner_file.hpp"

namespace understudy {

/// Those in a folder, by their names; none where there is no such folder. What cannot be read is left out and
/// logged.
std::vector<MannerFile> styles_in(const std::string& folder);
/// Those that come with the program.
std::vector<MannerFile> bundled_styles();

/// The file of a style, of whatever strength. Throws Error with the names that there are, or naming the file.
std::string style_file(const StyleChoice& choice);

/// Whether a style's file is a network's weights, for the engine `words` (nn::load_networks); else it is a
/// manner's.
bool is_words_file(const std::string& path);

/// The stage that performs in this style; null where nothing is to be changed. Throws Error naming the file.
std::shared_ptr<MotionStyle> load_style(const StyleChoice& choice);

}  // namespace understudy
