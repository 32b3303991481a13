// Where the bundled samples are.
#pragma once

#include <string>

namespace understudy::app {

/// The folder assets/samples beside the program or above it. Throws Error when there is none.
std::string samples_folder();

}  // namespace understudy::app
