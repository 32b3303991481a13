// The styles that were taught on this machine, and the teaching of another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "retarget/style/manner_file.hpp"

namespace understudy::app {

struct TaughtStyle {
  StyleNote note;
  std::string file;  ///< whole path, by which documents choose it
};

struct StylesState {
  std::vector<TaughtStyle> taught;  ///< by their names
  int64_t job = 0;                  ///< that taught last, or does; 0: none yet
};

/// The one of that name or file; null where there is none.
const TaughtStyle* taught_style(const StylesState& styles, const std::string& name_or_file);

}  // namespace understudy::app
