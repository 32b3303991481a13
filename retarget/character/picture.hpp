// Pictures that a character's materials use, by their bytes.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace understudy {

/// "image/png", "image/jpeg", "image/webp", "image/ktx2"; empty: none of those.
std::string picture_type(std::string_view bytes);

/// The bytes that `read` gives; a white pixel as PNG, and a warning that begins with `what`, where the file
/// is missing. Other failures go on.
std::string picture_or_white(const std::function<std::string()>& read, const std::string& what);

}  // namespace understudy
