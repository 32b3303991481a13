#include "app/session/series.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

/// In as few digits as give the same number again; the point is a point in every locale.
template <class Number>
void append(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append_seconds(std::string& text, double seconds) {
  append(text, std::round(seconds * 1e6) / 1e6);
}

}  // namespace

const Series* find(const std::vector<Series>& series, const std::string& key) {
  for (const Series& one : series)
    if (one.key == key) return &one;
  return nullptr;
}

void write_csv(const std::string& path, const std::vector<Series>& series, double fps,
               const std::vector<double>& take_seconds) {
  US_CHECK(fps > 0 && std::isfinite(fps), path, ": no time can be given at ", fps, " frames/s");
  size_t frames = 0;
  std::string text = take_seconds.empty() ? "frame,seconds" : "frame,seconds,take_seconds";
  for (const Series& one : series) {
    frames = std::max(frames, one.values.size());
    text += ',' + csv_cell(one.key);
  }
  text += '\n';
  for (size_t frame = 0; frame < frames; ++frame) {
    append(text, frame);
    text += ',';
    append_seconds(text, static_cast<double>(frame) / fps);
    if (!take_seconds.empty()) text += ',';
    if (frame < take_seconds.size()) append_seconds(text, take_seconds[frame]);
    for (const Series& one : series) {
      text += ',';
      if (frame < one.values.size() && std::isfinite(one.values[frame])) append(text, one.values[frame]);
    }
    text += '\n';
  }
  write_file(path, text);
}

}  // namespace understudy::app
