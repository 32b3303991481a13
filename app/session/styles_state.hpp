// The styles that were taught on this machine, and the teaching of another.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "retarget/style/manner_file.hpp"

namespace understudy::app {

struct TaughtStyle {
  StyleNote note;
  std::string file;  ///< whole path, by which documents choose it
};

/// What was removed from this machine; gone for good when the program ends.
struct ForgottenStyle {
  std::string name, file, text;  ///< the text of its file
};

struct StylesState {
  std::vector<TaughtStyle> taught;          ///< by their names
  int64_t job = 0;                          ///< that taught last, or does; 0: none yet
  std::optional<ForgottenStyle> forgotten;  ///< last, and can be brought back; none: nothing can
};

/// The one of that name or file; null where there is none.
const TaughtStyle* taught_style(const StylesState& styles, const std::string& name_or_file);

}  // namespace understudy::app
