// Where the bundled samples are.
#pragma once

#include <string>

namespace understudy::app {

/// The folder of the bundled samples (see program_files). Throws Error when there is none.
std::string samples_folder();

}  // namespace understudy::app
