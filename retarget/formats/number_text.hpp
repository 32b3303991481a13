// Numbers as text, the same in every country's settings.
#pragma once

#include <charconv>
#include <string>

namespace understudy {

/// Appends a value with this many digits after the point.
inline void append_fixed(std::string& out, double value, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  out.append(text, end.ptr);
}
/// The shortest text that reads back as the same float.
inline void append_exact(std::string& out, float value) {
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace understudy
