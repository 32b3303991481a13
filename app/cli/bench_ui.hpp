// Measures the studio: frames a second, delays, memory, start-up, measured without a window.
#pragma once

#include <string>

namespace understudy::app {

struct UiBenchOptions {
  std::string context = "any";  ///< egl, osmesa
  std::string weights;          ///< folder; empty: beside the program
  double seconds = 5;           ///< of each measurement
};

/// Prints a table. Throws Error.
int bench_ui(const UiBenchOptions& options);

}  // namespace understudy::app
